"""Why a router that takes calls does not let us in, as far as its door tells."""

import socket
import ssl
from pathlib import Path
from typing import NamedTuple

from navette.cli.doctor.ports import Process, environment, has_zenoh

_LOOK_S = 0.3
_OTHER_PORT = (
    "choose another port, the same for all: export NAVETTE_ROUTER=tcp/127.0.0.1:7448"
)


class Refusal(NamedTuple):
    """What is the matter, and what to do about it."""

    text: str
    advice: str


def refusal(
    endpoint: str,
    address: tuple[str, int],
    security: Path | None,
    process: Process | None,
) -> Refusal:
    """Look at the door of a router that does not speak with us.

    Args:
        endpoint: Zenoh's, as tcp/127.0.0.1:7447.
        security: folder of our credentials.
        process: who listens there, where that is known.
    """
    if process is not None and has_zenoh(process) is False:
        return Refusal("is no Zenoh program", _OTHER_PORT)
    found = _by_protocol(endpoint, address, security)
    return Refusal(found.text + _their_folder(security, process), found.advice)


def _by_protocol(
    endpoint: str, address: tuple[str, int], security: Path | None
) -> Refusal:
    ours = endpoint.startswith("tls/")
    theirs = speaks_tls(*address)
    if theirs and not ours:
        return Refusal(
            "wants TLS, and we come without",
            "export NAVETTE_SECURITY=FOLDER (navette keys create), and let the"
            " endpoints of NAVETTE_ROUTER and NAVETTE_LISTEN begin with tls/",
        )
    if ours and not theirs:
        return Refusal(
            "speaks no TLS, and we want it",
            "start that program with NAVETTE_SECURITY and tls/ endpoints, too, or"
            " none of both",
        )
    if ours:
        return _by_certificate(address, security)
    if security is not None and (security / "login").is_file():
        return Refusal(
            "does not take our name and password",
            f"compare {security / 'login'} with the file users over there",
        )
    return Refusal(
        "does not let us in: it wants a password, or speaks another protocol",
        f"export NAVETTE_SECURITY=FOLDER with a login; or {_OTHER_PORT}",
    )


def _by_certificate(address: tuple[str, int], security: Path | None) -> Refusal:
    if security is None:
        return Refusal(
            "wants a certificate, and we have none",
            "export NAVETTE_SECURITY=FOLDER, this machine's (navette keys create)",
        )
    advice = (
        "both need certificates of the same authority (navette keys create); is"
        f" NAVETTE_SECURITY={security} the right folder? navette keys show {security}"
    )
    trouble = distrust(*address, security)
    if trouble:
        return Refusal(f"has a certificate that we do not trust: {trouble}", advice)
    return Refusal("does not take our certificate or password", advice)


def _their_folder(security: Path | None, process: Process | None) -> str:
    """What it was started with, where that can be seen and is other than ours."""
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
    """Whether a TLS handshake gets an answer that is one."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    try:
        _shake_hands(host, port, context)
    except ssl.SSLError as error:
        return "ALERT" in str(error.reason)  # it wants to see our certificate
    except OSError:
        return False
    return True


def distrust(host: str, port: int, security: Path) -> str:
    """Why our authority does not vouch for that certificate; empty where it does."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False  # Zenoh does not look at names either
    try:
        context.load_verify_locations(security / "ca.pem")
        context.load_cert_chain(security / "cert.pem", security / "key.pem")
        _shake_hands(host, port, context)
    except ssl.SSLCertVerificationError as error:
        return error.verify_message
    except (ssl.SSLError, OSError):
        return ""
    return ""


def _shake_hands(host: str, port: int, context: ssl.SSLContext) -> None:
    with (
        socket.create_connection((host, port), _LOOK_S) as plain,
        context.wrap_socket(plain),
    ):
        return
