"""Why a router rejects the session: what is found out by knocking at its door."""

import datetime
import socket
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from navette.cli.doctor.network import Network, Router
from navette.cli.doctor.processes import Process
from navette.cli.doctor.router_diagnosis import (
    PortProbe,
    certificate_error,
    probe,
    refusal,
    speaks_tls,
)
from navette.runtime import SystemClock
from navette.transports.certificates import create_keys

# Certificates are compared with the machine's own clock.
NOW = datetime.datetime.fromtimestamp(SystemClock().now_ns / 1e9, datetime.UTC)


@contextmanager
def door(context: ssl.SSLContext | None = None) -> Iterator[tuple[str, int]]:
    """A program that takes calls; without a context it hangs up on all of them."""
    server = socket.create_server(("127.0.0.1", 0))

    def serve() -> None:
        while True:
            try:
                caller, _ = server.accept()
            except OSError:
                return
            with suppress(OSError), caller:
                if context is not None:
                    context.wrap_socket(caller, server_side=True).close()

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    try:
        yield server.getsockname()
    finally:
        server.shutdown(socket.SHUT_RDWR)
        server.close()
        thread.join()


@pytest.fixture(scope="module")
def keys(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two authorities: ours/robot, ours/laptop, theirs/robot."""
    folder = tmp_path_factory.mktemp("keys")
    create_keys(folder / "ours", ["robot", "laptop"], now=NOW)
    create_keys(folder / "theirs", ["robot"], now=NOW)
    return folder


@contextmanager
def tls_door(folder: Path) -> Iterator[tuple[str, int]]:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(folder / "cert.pem", folder / "key.pem")
    context.load_verify_locations(folder / "ca.pem")
    context.verify_mode = ssl.CERT_REQUIRED
    with door(context) as address:
        yield address


def test_a_door_with_tls_and_one_without(keys: Path) -> None:
    with door() as plain:
        assert not speaks_tls(*plain)
        found = refusal("tls/x:1", plain, keys / "ours" / "laptop", None)
        assert found.text.startswith("does not use TLS, which this program requires")
        found = refusal("tcp/x:1", plain, None, None)
        assert "it requires a password" in found.text
    with tls_door(keys / "ours" / "robot") as closed:
        assert speaks_tls(*closed)
        found = refusal("tcp/x:1", closed, None, None)
        assert found.text == "requires TLS, which this program does not use"
        assert "NAVETTE_SECURITY" in found.advice
        found = refusal("tls/x:1", closed, None, None)
        assert found.text == "requires a certificate, and this program has none"


def test_a_certificate_of_another_authority(keys: Path) -> None:
    with tls_door(keys / "theirs" / "robot") as address:
        trouble = certificate_error(*address, keys / "ours" / "laptop")
        assert trouble
        found = refusal("tls/x:1", address, keys / "ours" / "laptop", None)
        assert found.text == f"has a certificate that is not trusted here: {trouble}"
    with tls_door(keys / "ours" / "robot") as address:
        assert certificate_error(*address, keys / "ours" / "laptop") == ""
        found = refusal("tls/x:1", address, keys / "ours" / "laptop", None)
        assert found.text == "rejects the certificate or password"


def test_a_password(tmp_path: Path) -> None:
    (tmp_path / "login").write_text("robot:secret")
    with door() as address:
        found = refusal("tcp/x:1", address, tmp_path, None)
    assert found.text == "rejects the user name and password"
    assert str(tmp_path / "login") in found.advice


def test_a_program_without_zenoh() -> None:
    shell = Process(1, 0, ("sh",))
    with door() as address:
        found = refusal("tcp/x:1", address, None, shell)
    # Of another user's process nothing can be seen.
    assert found.text.startswith(("is not a Zenoh program", "rejects the session"))


def test_probing_a_port() -> None:
    with door() as (host, port):
        assert probe(host, port) is PortProbe.OPEN
    assert probe(host, port) is PortProbe.REFUSED
    assert probe("no.such.name.invalid", 1) is PortProbe.UNKNOWN_HOST


def test_an_unreachable_router_needs_no_connection() -> None:
    far = Router("tcp/10.0.0.2:7447", PortProbe.TIMED_OUT)
    assert Network(routers=(far,)).is_out_of_reach
    here = Router("tcp/127.0.0.1:7447", PortProbe.REFUSED)
    for routers in ((far, here), (far, Router("quic/10.0.0.3:1")), ()):
        assert not Network(routers=routers).is_out_of_reach
    assert not Network(routers=(far,), session_file="scouts.json5").is_out_of_reach
