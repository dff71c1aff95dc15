"""Access control: certificates, passwords and access rules from one folder.

The files in the folder (``NAVETTE_SECURITY``) define what every link requires:

======================  ===========================================================
``ca.pem``              authority whose certificates are accepted
``cert.pem, key.pem``   identity of this process; every link uses mutual TLS
``login``               ``name:password`` of this process
``users``               ``name:password`` lines of all processes that may join
``access.json5``        Zenoh's ``access_control`` block
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
    """A folder of credentials.

    Raises:
        InvalidValueError: the folder does not exist or contains none of the files.
        FileFormatError: a file is missing that another one requires.
    """

    folder: Path

    def __post_init__(self) -> None:
        if not self.folder.is_dir():
            raise InvalidValueError(f"NAVETTE_SECURITY: {self.folder} is not a folder")
        names = (*_CERTIFICATES, *_LOGIN, _ACCESS)
        if not any(self._has(name) for name in names):
            raise InvalidValueError(
                f"NAVETTE_SECURITY: no credentials in {self.folder}; expected some of "
                f"{', '.join(names)}"
            )
        for group in (_CERTIFICATES, _LOGIN):
            missing = [name for name in group if not self._has(name)]
            if missing and len(missing) < len(group):
                raise FileFormatError(
                    self.folder / missing[0],
                    f"missing; required together with {', '.join(group)}",
                )

    @property
    def is_encrypted(self) -> bool:
        """Whether every link uses mutual TLS."""
        return self._has("cert.pem")

    def describe(self) -> list[str]:
        """Return what every link requires, as text.

        Raises:
            FileFormatError: a file is invalid.
        """
        self.apply(zenoh.Config())
        lines = [
            "TLS with certificates on both sides" if self.is_encrypted else "no TLS"
        ]
        if self._has("login"):
            lines.append(f"passwords; user of this process: {self._login()['user']}")
        if self._has(_ACCESS):
            lines.append("access rules")
        return lines

    def apply(self, config: zenoh.Config) -> None:
        """Insert the requirements into a Zenoh configuration."""
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
            # Peers learn addresses by discovery, and robots change theirs: a
            # certificate of this authority is sufficient.
            "verify_name_on_connect": False,
        }

    def _login(self) -> dict[str, str]:
        name, colon, password = self._text("login").strip().partition(":")
        if not (name and colon and password):
            raise FileFormatError(
                self.folder / "login", "expected one line name:password"
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
