"""Certificates for mutual TLS: an authority, and a certificate for each machine.

X.509 version 3 (RFC 5280) with P-256 keys; both key usages, because every process
listens and connects. Importing this module raises MissingPartError if the package
``cryptography`` is not installed.
"""

import datetime
import ipaddress
import os
import re
from collections.abc import Sequence
from pathlib import Path

from navette.errors import InvalidValueError, MissingPartError
from navette.files.writing import writing

try:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID as Usage
except ImportError as error:
    raise MissingPartError.of("creating keys", "cryptography", "security") from error

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,62}")


def create_keys(
    folder: Path, names: Sequence[str], *, now: datetime.datetime, days: int = 365
) -> list[Path]:
    """Create a folder of keys for each name below ``folder``.

    Each folder contains ``ca.pem``, ``cert.pem`` and ``key.pem``, as required by
    ``NAVETTE_SECURITY``. The authority is created if there is none; its ``ca.key``
    signs further certificates, so keep it away from the robots.

    Args:
        now: start of validity (with a time zone).
        days: period of validity.

    Raises:
        InvalidValueError: a name is invalid or has keys already.
        FileFormatError: the folder cannot be written.
    """
    for name in names:
        if not _NAME.fullmatch(name):
            raise InvalidValueError(
                f"name {name!r}: expected at most 63 letters, digits, '-', '_' and '.'"
            )
        if (folder / name).exists():
            raise InvalidValueError(f"{folder / name} exists already")
    with writing(folder):
        authority = _Authority.of(folder, now, days)
        return [authority.issue(name, now, days) for name in names]


class _Authority:
    """Signs certificates; its key and certificate are files in the folder."""

    def __init__(
        self,
        folder: Path,
        key: ec.EllipticCurvePrivateKey,
        certificate: x509.Certificate,
    ) -> None:
        self._folder = folder
        self._key = key
        self._certificate = certificate

    @classmethod
    def of(cls, folder: Path, now: datetime.datetime, days: int) -> "_Authority":
        """Return the authority of the folder, created if there is none."""
        if (folder / "ca.key").is_file():
            data = (folder / "ca.key").read_bytes()
            key = serialization.load_pem_private_key(data, None)
            if not isinstance(key, ec.EllipticCurvePrivateKey):
                raise InvalidValueError(
                    f"{folder / 'ca.key'} is not an elliptic-curve key"
                )
            text = (folder / "ca.pem").read_bytes()
            return cls(folder, key, x509.load_pem_x509_certificate(text))
        folder.mkdir(parents=True, exist_ok=True)
        made = ec.generate_private_key(ec.SECP256R1())
        name = _name("navette authority")
        certificate = (
            _begin(name, name, made, now, days)
            .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
            .sign(made, hashes.SHA256())
        )
        _write_key(folder / "ca.key", made)
        (folder / "ca.pem").write_bytes(_pem(certificate))
        return cls(folder, made, certificate)

    def issue(self, name: str, now: datetime.datetime, days: int) -> Path:
        """Create a key and its certificate."""
        key = ec.generate_private_key(ec.SECP256R1())
        names = [
            x509.DNSName(name),
            x509.DNSName(f"{name}.local"),  # its name on a network without DNS
            x509.DNSName("localhost"),
            x509.IPAddress(ipaddress.ip_address("127.0.0.1")),
        ]
        certificate = (
            _begin(_name(name), self._certificate.subject, key, now, days)
            .add_extension(x509.BasicConstraints(ca=False, path_length=None), True)
            .add_extension(x509.SubjectAlternativeName(names), critical=False)
            .add_extension(
                x509.ExtendedKeyUsage([Usage.SERVER_AUTH, Usage.CLIENT_AUTH]), False
            )
            .sign(self._key, hashes.SHA256())
        )
        folder = self._folder / name
        folder.mkdir()
        _write_key(folder / "key.pem", key)
        (folder / "cert.pem").write_bytes(_pem(certificate))
        (folder / "ca.pem").write_bytes(_pem(self._certificate))
        return folder


def _name(text: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, text)])


def _begin(
    subject: x509.Name,
    issuer: x509.Name,
    key: ec.EllipticCurvePrivateKey,
    now: datetime.datetime,
    days: int,
) -> x509.CertificateBuilder:
    # The clock of a robot may be slow.
    early = now - datetime.timedelta(hours=1)
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(early)
        .not_valid_after(now + datetime.timedelta(days=days))
    )


def _pem(certificate: x509.Certificate) -> bytes:
    return certificate.public_bytes(serialization.Encoding.PEM)


def _write_key(path: Path, key: ec.EllipticCurvePrivateKey) -> None:
    """Write a key readable by its owner only, from the first byte on."""
    text = key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "wb") as file:
        file.write(text)
