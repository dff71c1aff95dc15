"""Why a router cannot be reached, or rejects the connection."""

import socket
import ssl
from enum import Enum
from pathlib import Path
from typing import NamedTuple

from navette.cli.doctor.processes import Process, environment, has_zenoh

_TLS_TIMEOUT_S = 0.3
_OTHER_PORT = (
    "choose another port for all programs: export NAVETTE_ROUTER=tcp/127.0.0.1:7448"
)


class PortProbe(Enum):
    """Result of a TCP connection attempt."""

    OPEN = "open"
    REFUSED = "refused"
    TIMED_OUT = "timed out"
    UNREACHABLE = "unreachable"
    UNKNOWN_HOST = "unknown host"


class Refusal(NamedTuple):
    """Reason of a rejected connection, and what to do."""

    text: str
    advice: str


def probe(host: str, port: int, timeout_s: float = 0.2) -> PortProbe:
    """Try to connect."""
    try:
        with socket.create_connection((host, port), timeout_s):
            return PortProbe.OPEN
    except socket.gaierror:
        return PortProbe.UNKNOWN_HOST
    except TimeoutError:
        return PortProbe.TIMED_OUT
    except ConnectionRefusedError:
        return PortProbe.REFUSED
    except OSError:
        return PortProbe.UNREACHABLE


def refusal(
    endpoint: str,
    address: tuple[str, int],
    security: Path | None,
    process: Process | None,
) -> Refusal:
    """Find out why an open port rejects the Zenoh session.

    Args:
        endpoint: Zenoh endpoint, such as tcp/127.0.0.1:7447.
        address: host and port of the endpoint.
        security: folder of this program's credentials.
        process: the process that listens there, if visible.
    """
    if process is not None and has_zenoh(process) is False:
        return Refusal("is not a Zenoh program", _OTHER_PORT)
    found = _by_protocol(endpoint, address, security)
    return Refusal(found.text + _other_folder(security, process), found.advice)


def _by_protocol(
    endpoint: str, address: tuple[str, int], security: Path | None
) -> Refusal:
    ours = endpoint.startswith("tls/")
    theirs = speaks_tls(*address)
    if theirs and not ours:
        return Refusal(
            "requires TLS, which this program does not use",
            "export NAVETTE_SECURITY=FOLDER (navette keys create), and let the"
            " endpoints of NAVETTE_ROUTER and NAVETTE_LISTEN begin with tls/",
        )
    if ours and not theirs:
        return Refusal(
            "does not use TLS, which this program requires",
            "start that program with NAVETTE_SECURITY and tls/ endpoints as well, or"
            " use neither in both",
        )
    if ours:
        return _by_certificate(address, security)
    if security is not None and (security / "login").is_file():
        return Refusal(
            "rejects the user name and password",
            f"compare {security / 'login'} with the file users of the router",
        )
    return Refusal(
        "rejects the session: it requires a password or uses another protocol",
        f"export NAVETTE_SECURITY=FOLDER with a file login; or {_OTHER_PORT}",
    )


def _by_certificate(address: tuple[str, int], security: Path | None) -> Refusal:
    if security is None:
        return Refusal(
            "requires a certificate, and this program has none",
            "export NAVETTE_SECURITY=FOLDER of this machine (navette keys create)",
        )
    advice = (
        "both need certificates of the same authority (navette keys create); check"
        f" NAVETTE_SECURITY={security} with navette keys show {security}"
    )
    error = certificate_error(*address, security)
    if error:
        return Refusal(f"has a certificate that is not trusted here: {error}", advice)
    return Refusal("rejects the certificate or password", advice)


def _other_folder(security: Path | None, process: Process | None) -> str:
    """Report that the process was started with another NAVETTE_SECURITY."""
    if process is None:
        return ""
    theirs = environment(process).get("NAVETTE_SECURITY", "")
    if Path(theirs or ".") == Path(security or "."):
        return ""
    return (
        f"; NAVETTE_SECURITY is {theirs or 'not set'} there,"
        f" {security or 'not set'} here"
    )


def speaks_tls(host: str, port: int) -> bool:
    """Whether the port responds to a TLS handshake."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    try:
        _handshake(host, port, context)
    except ssl.SSLError as error:
        return "ALERT" in str(error.reason)  # it requires a client certificate
    except OSError:
        return False
    return True


def certificate_error(host: str, port: int, security: Path) -> str:
    """Return why this program's authority rejects the certificate; empty if valid."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False  # as in Zenoh
    try:
        context.load_verify_locations(security / "ca.pem")
        context.load_cert_chain(security / "cert.pem", security / "key.pem")
        _handshake(host, port, context)
    except ssl.SSLCertVerificationError as error:
        return error.verify_message
    except (ssl.SSLError, OSError):
        return ""
    return ""


def _handshake(host: str, port: int, context: ssl.SSLContext) -> None:
    with (
        socket.create_connection((host, port), _TLS_TIMEOUT_S) as plain,
        context.wrap_socket(plain),
    ):
        return
