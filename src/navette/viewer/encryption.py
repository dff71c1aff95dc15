"""TLS of the live view, with the certificates of ``NAVETTE_SECURITY``."""

import ssl
from pathlib import Path

from navette.errors import FileFormatError, InvalidValueError

VARIABLE = "NAVETTE_SECURITY"


def tls_context(folder: Path) -> ssl.SSLContext | None:
    """Return the server's context; None if the folder holds no certificate.

    A client may present a certificate of the same authority instead of a token.

    Raises:
        InvalidValueError: the folder does not exist.
        FileFormatError: a file is missing or invalid.
    """
    if not folder.is_dir():
        raise InvalidValueError(f"{VARIABLE}: {folder} is not a folder")
    cert, key, authority = (folder / f"{name}.pem" for name in ("cert", "key", "ca"))
    if not cert.exists():
        return None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    context.verify_mode = ssl.CERT_OPTIONAL
    try:
        context.load_cert_chain(cert, key)
        context.load_verify_locations(authority)
    except (OSError, ssl.SSLError) as error:
        raise FileFormatError(cert, f"{VARIABLE}: {error}") from error
    return context
