"""Who may join: certificates, passwords and access rules from one folder.

What the folder holds says what is asked for (``NAVETTE_SECURITY``):

======================  ===========================================================
``ca.pem``              whose certificates are trusted
``cert.pem, key.pem``   who this process is; every link is TLS, both sides show one
``login``               ``name:password`` that this process gives
``users``               ``name:password`` lines of those who may join
``access.json5``        Zenoh's ``access_control`` block: who may do what
======================  ===========================================================
"""

import json
from dataclasses import dataclass
from pathlib import Path

import zenoh

from navette.errors import FileFormatError, InvalidValueError

_CERTIFICATES = ("ca.pem", "cert.pem", "key.pem")
_LOGIN = ("login", "users")
_ACCESS = "access.json5"
_MAX_BYTES = 1 << 20


@dataclass(frozen=True)
class Security:
    """A folder of credentials, looked through once.

    Raises:
        InvalidValueError: there is no such folder, or nothing in it that counts.
        FileFormatError: a file is missing beside another one, or is not as it should.
    """

    folder: Path

    def __post_init__(self) -> None:
        if not self.folder.is_dir():
            raise InvalidValueError(f"NAVETTE_SECURITY: no folder {self.folder}")
        names = (*_CERTIFICATES, *_LOGIN, _ACCESS)
        if not any(self._has(name) for name in names):
            raise InvalidValueError(
                f"NAVETTE_SECURITY: nothing in {self.folder}; wanted some of "
                f"{', '.join(names)}"
            )
        for group in (_CERTIFICATES, _LOGIN):
            missing = [name for name in group if not self._has(name)]
            if missing and len(missing) < len(group):
                raise FileFormatError(
                    self.folder / missing[0],
                    f"missing; it goes with {', '.join(group)}",
                )

    @property
    def is_encrypted(self) -> bool:
        """Whether every link is TLS with certificates on both sides."""
        return self._has("cert.pem")

    def describe(self) -> list[str]:
        """What is asked of every link, in words; raises where a file is not right."""
        self.apply(zenoh.Config())
        lines = [
            "TLS with certificates on both sides" if self.is_encrypted else "no TLS"
        ]
        if self._has("login"):
            lines.append(f"passwords; this is {self._login()['user']}")
        if self._has(_ACCESS):
            lines.append("access rules")
        return lines

    def apply(self, config: zenoh.Config) -> None:
        """Ask of every link what the folder says."""
        if self.is_encrypted:
            self._insert(config, "transport/link/protocols", ["tls"])
            self._insert(config, "transport/link/tls", self._tls())
        if self._has("login"):
            self._insert(config, "transport/auth/usrpwd", self._login())
        if self._has(_ACCESS):
            try:
                config.insert_json5("access_control", self._text(_ACCESS))
            except zenoh.ZError as error:
                raise FileFormatError(self.folder / _ACCESS, str(error)) from error

    def _tls(self) -> dict[str, object]:
        ca, cert, key = (str(self.folder / name) for name in _CERTIFICATES)
        return {
            "root_ca_certificate": ca,
            "listen_certificate": cert,
            "listen_private_key": key,
            "connect_certificate": cert,
            "connect_private_key": key,
            "enable_mtls": True,
            # Peers learn each other's addresses on the way, and robots change
            # theirs: who has a certificate of this authority is let in.
            "verify_name_on_connect": False,
        }

    def _login(self) -> dict[str, str]:
        name, colon, password = self._text("login").strip().partition(":")
        if not (name and colon and password):
            raise FileFormatError(
                self.folder / "login", "wanted one line name:password"
            )
        return {
            "user": name,
            "password": password,
            "dictionary_file": str(self.folder / "users"),
        }

    def _has(self, name: str) -> bool:
        return (self.folder / name).is_file()

    def _text(self, name: str) -> str:
        path = self.folder / name
        if path.stat().st_size > _MAX_BYTES:
            raise FileFormatError(path, f"longer than {_MAX_BYTES} bytes")
        try:
            return path.read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            raise FileFormatError(path, "not UTF-8") from error

    @staticmethod
    def _insert(config: zenoh.Config, key: str, value: object) -> None:
        config.insert_json5(key, json.dumps(value))
