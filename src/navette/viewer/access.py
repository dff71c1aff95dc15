"""What the live view requires of clients, from its parameters and the environment."""

import ipaddress
import socket
import ssl
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from navette.errors import InvalidValueError
from navette.viewer.encryption import VARIABLE, tls_context
from navette.viewer.listening import url_of
from navette.viewer.login import TOKEN_VARIABLE, Login, new_token
from navette.viewer.params import ViewerParams
from navette.viewer.wall_clock import WallClock

_MAX_USERS = 1 << 16  # bytes of the file


@dataclass(frozen=True)
class Access:
    """Encryption and login of a live view.

    Args:
        login: decides who is accepted.
        token: for clients that are not programs of this user; empty if not required.
        tls: None without encryption.
        is_remote: other machines can connect.
    """

    login: Login
    token: str
    tls: ssl.SSLContext | None
    is_remote: bool

    @classmethod
    def of(
        cls, params: ViewerParams, environment: Mapping[str, str], clock: WallClock
    ) -> "Access":
        """Read the token and the keys.

        Raises:
            InvalidValueError: other machines could connect without encryption, which
                the parameters do not allow; or the token is too short.
            FileFormatError: a key is missing or invalid.
        """
        is_remote = not is_loopback(params.host)
        folder = environment.get(VARIABLE, "")
        tls = tls_context(Path(folder)) if folder and is_remote else None
        if is_remote and tls is None and not params.allow_unencrypted:
            raise InvalidValueError(
                f"viewer: other machines reach host {params.host}, and nothing "
                f"encrypts the connections: set {VARIABLE} to a folder of keys "
                "(navette keys create), or permit it: --unencrypted, or the viewer's "
                "parameter allow_unencrypted"
            )
        is_open = is_remote and params.allow_anyone
        token = "" if is_open else new_token(environment.get(TOKEN_VARIABLE))
        tokens = [token, *_users(Path(folder))] if folder else [token]
        login = Login(tokens, clock, is_required=not is_open)
        return cls(login, token, tls, is_remote)

    def url(self, host: str, port: int) -> str:
        """Return the page's address for this user on this machine."""
        return url_of(host, port, "https" if self.tls else "http")

    def remote_url(self, host: str, port: int) -> str:
        """Return the page's address for other users and machines, with the token."""
        if self.is_remote and _is_wildcard(host):
            host = _own_address()
        fragment = f"/#token={self.token}" if self.token else ""
        return self.url(host, port) + fragment


def scheme_of(host: str, environment: Mapping[str, str]) -> str:
    """Return the scheme of the page's address: https with keys, beyond this machine."""
    folder = environment.get(VARIABLE, "")
    is_encrypted = folder and (Path(folder) / "cert.pem").exists()
    return "https" if is_encrypted and not is_loopback(host) else "http"


def is_loopback(host: str) -> bool:
    """Whether only programs of this machine reach a listening address."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _is_wildcard(host: str) -> bool:
    return host in ("0.0.0.0", "::", "")


def _users(folder: Path) -> list[str]:
    """Return the lines ``name:password`` of ``users``; each is accepted as a token."""
    path = folder / "users"
    if not path.is_file() or path.stat().st_size > _MAX_USERS:
        return []
    lines = path.read_text(encoding="utf-8", errors="replace").split()
    return [line for line in lines if line.partition(":")[2]]


def _own_address() -> str:
    """Return the address of this machine on its network."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # selects the interface, sends nothing
            return str(probe.getsockname()[0])
        except OSError:
            return socket.gethostname()
