"""Login: users, tokens, certificates, origins; TLS."""

import datetime
import json
import os
import socket
import ssl
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from viewer_fakes import FakeClock, FakeDocuments
from viewer_harness import Client, Program
from websockets.exceptions import ConnectionClosed, InvalidMessage, InvalidStatus

from navette.errors import FileFormatError, InvalidValueError
from navette.runtime import Context, Node, SystemClock
from navette.transports.certificates import create_keys
from navette.viewer.access import Access, is_loopback, scheme_of
from navette.viewer.gate import Gate, WebRequest
from navette.viewer.login import Login, Visitor, new_token, token_of
from navette.viewer.page_files import PageFile
from navette.viewer.params import ViewerParams
from navette.viewer.peer_user import is_trusted, owner_of, user_of
from navette.viewer.web import AccessPolicy, Site

NOW = datetime.datetime.fromtimestamp(SystemClock().now_ns / 1e9, datetime.UTC)
REFUSED = (ConnectionError, ConnectionClosed, ssl.SSLError, InvalidMessage)
TOKEN = "correct-horse-battery"
OWN = Visitor("127.0.0.1", user=os.geteuid())
OTHER = Visitor("127.0.0.1", user=os.geteuid() + 1)
LAN = Visitor("192.168.1.9")
KEY = Visitor("192.168.1.9", has_certificate=True)


def status(visitor: Visitor, token: str | None, login: Login | None = None) -> int:
    refused = (login or Login([TOKEN], FakeClock())).refusal(visitor, token)
    return 200 if refused is None else refused.status


@pytest.mark.parametrize(
    ("visitor", "token", "expected"),
    [
        (OWN, None, 200),
        (OWN, "wrong", 200),
        (KEY, None, 200),
        (OTHER, None, 401),
        (OTHER, "wrong", 401),
        (OTHER, TOKEN, 200),
        (LAN, None, 401),
        (LAN, "", 401),
        (LAN, TOKEN + "a", 401),
        (LAN, TOKEN[:-1], 401),
        (LAN, "\ud800é", 401),
        (LAN, TOKEN, 200),
    ],
)
def test_other_users_and_machines_need_the_token(
    visitor: Visitor, token: str | None, expected: int
) -> None:
    assert status(visitor, token) == expected


def test_wrong_tokens_are_limited_by_address() -> None:
    time = FakeClock()
    login = Login([TOKEN], time)
    answers = [status(LAN, f"guess {n}", login) for n in range(15)]
    assert answers == [401] * 10 + [429] * 5
    assert status(LAN, TOKEN, login) == 429, "a guess that is right is not noticed"
    assert status(Visitor("192.168.1.10"), TOKEN, login) == 200
    time.now_s = 6.0
    assert status(LAN, TOKEN, login) == 200


def test_missing_tokens_are_not_counted_as_wrong() -> None:
    login = Login([TOKEN], FakeClock())
    assert [status(LAN, None, login) for _ in range(50)] == [401] * 50
    assert status(LAN, TOKEN, login) == 200


def test_the_failures_of_many_addresses_take_bounded_memory() -> None:
    login = Login([TOKEN], FakeClock())
    for number in range(3000):
        login.refusal(Visitor(f"10.0.{number >> 8}.{number & 255}"), "guess")
    assert len(login._failures) == 1000


def test_random_tokens_differ_and_short_ones_are_refused() -> None:
    assert len({new_token(None) for _ in range(100)}) == 100
    assert len(new_token("")) >= 20
    assert new_token(TOKEN) == TOKEN
    for bad in ("short", "ä" * 20):
        with pytest.raises(InvalidValueError, match="at least 12 ASCII"):
            new_token(bad)


@pytest.mark.parametrize(
    ("target", "authorization", "token"),
    [
        ("/", None, None),
        ("/?token=a", None, "a"),
        ("/?x=1&token=a%2Fb&token=c", None, "a/b"),
        ("/?token=", None, None),
        ("/", "Bearer a", "a"),
        ("/?token=a", "bearer b", "b"),
        ("/?token=a", "Basic b", "a"),
        ("/?" + "&".join("token=a" for _ in range(99)), None, None),
        ("//[", None, None),
    ],
)
def test_tokens_are_in_the_address_or_a_header(
    target: str, authorization: str | None, token: str | None
) -> None:
    assert token_of(target, authorization) == token


# -- origins -------------------------------------------------------------------------


PAGE = PageFile("text/html", b"page")


class Notes:
    """Notes refused pages and users."""

    def __init__(self, notes: list[str]) -> None:
        self._notes = notes

    def image_refused(self, reason: str) -> None:
        raise AssertionError(reason)

    def origin_refused(self, reason: str) -> None:
        self._notes.append(reason)

    def user_refused(self) -> None:
        self._notes.append("denied")


def gate(notes: list[str]) -> Gate:
    return Gate(
        AccessPolicy("127.0.0.1", ("https://app.foxglove.dev",)),
        Login([TOKEN], FakeClock()),
        Site({"/": PAGE, "/a.js": PAGE}, FakeDocuments()),
        problems=Notes(notes),
    )


def web_request(
    origin: str | None,
    visitor: Visitor = OWN,
    target: str = "/",
    host: str = "127.0.0.1",
) -> WebRequest:
    return WebRequest("GET", target, host, origin, None, visitor)


@pytest.mark.parametrize("origin", ["file://", "null", "http://localhost:3000"])
def test_local_pages_are_refused_and_named_once(origin: str) -> None:
    notes = list[str]()
    checked = gate(notes)
    for _ in range(3):
        refused = checked.refusal(web_request(origin))
        assert refused is not None
        assert refused.status == 403
    (note,) = notes
    assert origin in note
    assert "allowed_origins" in note


def test_a_page_with_the_token_needs_no_allowed_origin() -> None:
    checked = gate([])
    assert checked.refusal(web_request("file://", target=f"/?token={TOKEN}")) is None
    refused = checked.refusal(web_request("file://", target="/?token=wrong"))
    assert refused is not None
    assert refused.status == 401


def test_the_token_does_not_replace_the_host() -> None:
    request = web_request(None, target=f"/?token={TOKEN}", host="evil.example")
    refused = gate([]).refusal(request)
    assert refused is not None
    assert refused.status == 403


@pytest.mark.parametrize(
    ("target", "expected"),
    [("/", 200), ("/a.js", 200), ("/health", 401), ("/layout.json", 401), ("/x", 401)],
)
def test_only_the_page_is_served_without_login(target: str, expected: int) -> None:
    assert gate([]).page(web_request(None, LAN, target)).status == expected
    assert gate([]).page(web_request(None, LAN, f"{target}?token={TOKEN}")).status in (
        200,
        404,
    )


# -- users of this machine -------------------------------------------------------------

TABLE = """\
  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode
   0: 0100007F:223D 00000000:0000 0A 00000000:00000000 00:00000000 00000000  1000        0 11 1
   1: 0100007F:223D 0100007F:9C40 01 00000000:00000000 00:00000000 00000000  1000        0 12 1
   2: 0100007F:9C40 0100007F:223D 01 00000000:00000000 00:00000000 00000000    33        0 13 1
   3: 0100007F:9C41 0100007F:223D 01 00000000:00000000 00:00000000 00000000     0        0 0 1
   4: 0100007F:9C42 0100007F:223D 06 00000000:00000000 03:00000EB9 00000000     0        0 0 3
   5: 0000000000000000FFFF00000100007F:9C43 0000000000000000FFFF00000100007F:223D 01 00000000:00000000 00:00000000 00000000  1001        0 14 1
   6: 00000000000000000000000001000000:9C44 00000000000000000000000001000000:223D 01 00000000:00000000 00:00000000 00000000  1002        0 15 1
"""  # noqa: E501 - as the kernel prints it


@pytest.mark.parametrize(
    ("address", "port", "owner"),
    [
        ("127.0.0.1", 0x9C40, 33),
        ("127.0.0.1", 0x9C41, None),  # without a process
        ("127.0.0.1", 0x9C42, None),  # closed
        ("127.0.0.1", 0x9C43, 1001),  # through an IPv6 socket
        ("::1", 0x9C44, 1002),
        ("127.0.0.1", 0x9C45, None),
        ("127.0.0.2", 0x9C40, None),
    ],
)
def test_the_kernels_table_names_the_owner_of_a_connection(
    address: str, port: int, owner: int | None
) -> None:
    server = ("::1" if ":" in address else "127.0.0.1", 0x223D)
    assert owner_of((address, port), server, TABLE, order="little") == owner


def test_a_connection_of_this_process_belongs_to_this_user(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        socket.create_connection(server.getsockname()) as client,
    ):
        ends = client.getsockname(), server.getsockname()
        uid = os.geteuid()
        assert user_of(*ends) == uid
        assert is_trusted(uid)
        assert user_of(("192.168.1.9", 5), ends[1]) is None
        assert user_of(("127.0.0.1", 1), ends[1]) is None
    assert not is_trusted(None)
    monkeypatch.setattr(os, "geteuid", lambda: uid + 1)
    assert is_trusted(uid + 1)
    assert not is_trusted(uid + 2)


# -- beyond this machine ---------------------------------------------------------------


@pytest.mark.parametrize(
    ("host", "expected"),
    [("127.0.0.1", True), ("::1", True), ("localhost", True), ("127.9.9.9", True),
     ("0.0.0.0", False), ("::", False), ("", False), ("robot", False)],
)  # fmt: skip
def test_loopback_hosts_are_recognised(host: str, expected: bool) -> None:
    assert is_loopback(host) is expected


@pytest.fixture(scope="module")
def keys(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("keys")
    create_keys(folder, ["robot", "laptop"], now=NOW)
    return folder


def client_tls(keys: Path) -> ssl.SSLContext:
    context = ssl.create_default_context(cafile=keys / "ca.pem")
    # With TLS 1.3 the client reads session tickets in one thread while it sends the
    # request in another, which OpenSSL does not allow: requests get lost.
    context.maximum_version = ssl.TLSVersion.TLSv1_2
    return context


def access(environment: dict[str, str], **params: Any) -> Access:
    return Access.of(ViewerParams(**params), environment, FakeClock())


def test_other_machines_need_encryption_or_a_plain_permission(keys: Path) -> None:
    with pytest.raises(InvalidValueError, match=r"NAVETTE_SECURITY.*allow_unencrypted"):
        access({}, host="0.0.0.0")
    plain = access({}, host="0.0.0.0", allow_unencrypted=True)
    assert plain.tls is None
    assert "/#token=" in plain.remote_url("0.0.0.0", 8765)
    assert plain.login.refusal(LAN, None) is not None
    encrypted = access({"NAVETTE_SECURITY": str(keys / "robot")}, host="0.0.0.0")
    assert encrypted.tls is not None
    assert encrypted.url("0.0.0.0", 8765) == "https://127.0.0.1:8765"
    environment = {"NAVETTE_SECURITY": str(keys / "robot")}
    schemes = [scheme_of(host, environment) for host in ("0.0.0.0", "127.0.0.1")]
    assert schemes == ["https", "http"]


def test_a_login_is_dropped_only_by_its_own_parameter() -> None:
    opened = access({}, host="0.0.0.0", allow_unencrypted=True, allow_anyone=True)
    assert opened.login.refusal(LAN, None) is None
    local = access({}, allow_anyone=True)
    assert local.login.refusal(OTHER, None) is not None, "it concerns other machines"


def test_logins_of_the_security_folder_are_tokens(tmp_path: Path) -> None:
    (tmp_path / "users").write_text("robot:SECRET\nlaptop:OTHER\nempty:\n")
    (tmp_path / "login").write_text("robot:SECRET")
    environment = {"NAVETTE_SECURITY": str(tmp_path)}
    made = access(environment, host="0.0.0.0", allow_unencrypted=True)
    assert made.login.refusal(LAN, "laptop:OTHER") is None
    for wrong in ("laptop:SECRET", "laptop:", "empty:", ""):
        assert made.login.refusal(LAN, wrong) is not None


def test_invalid_keys_are_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="is not a folder"):
        access({"NAVETTE_SECURITY": str(tmp_path / "none")}, host="0.0.0.0")
    (tmp_path / "cert.pem").write_text("x")
    with pytest.raises(FileFormatError, match="NAVETTE_SECURITY"):
        access({"NAVETTE_SECURITY": str(tmp_path)}, host="0.0.0.0")


def talker(context: Context) -> Node:
    node = Node("talker", context=context)
    node.declare_parameter("depth", 3)
    return node


@pytest.fixture
def other_users(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every connection belongs to another user."""
    monkeypatch.setattr("navette.viewer.server.user_of", lambda *_: os.geteuid() + 1)


@pytest.fixture
def program(other_users: None, monkeypatch: pytest.MonkeyPatch) -> Iterator[Program]:
    monkeypatch.setenv("NAVETTE_VIEW_TOKEN", TOKEN)
    with Program(talker) as running:
        yield running


def test_the_token_opens_socket_and_files(
    program: Program, capsys: pytest.CaptureFixture[str]
) -> None:
    for address in (program.address, f"{program.address}/?token=wrong"):
        with pytest.raises(InvalidStatus, match="401"):
            Client(address)
    with Client(f"{program.address}/?token={TOKEN}") as client:
        assert client.get_parameters("/talker.depth") == {"/talker.depth": 3}
    header = {"Authorization": f"Bearer {TOKEN}"}
    with Client(program.address, additional_headers=header):
        pass
    with urllib.request.urlopen(f"http://{program.address}/") as page:
        assert b"<title>Navette</title>" in page.read()
    with pytest.raises(urllib.error.HTTPError, match="401"):
        urllib.request.urlopen(f"http://{program.address}/health")
    address = f"http://{program.address}/health?token={TOKEN}"
    with urllib.request.urlopen(address) as health:
        assert json.load(health)["status"] == "ok"
    assert capsys.readouterr().err.count(f"/#token={TOKEN}") == 1


def test_keys_encrypt_the_live_view_and_replace_the_token(
    other_users: None, keys: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_SECURITY", str(keys / "robot"))
    monkeypatch.setenv("NAVETTE_VIEW_TOKEN", TOKEN)
    trusting, with_key = client_tls(keys), client_tls(keys)
    with_key.load_cert_chain(keys / "laptop/cert.pem", keys / "laptop/key.pem")
    with Program(talker, host="0.0.0.0") as program:
        assert program.viewer.remote_url.startswith("https://")
        assert program.viewer.remote_url.endswith(f"/#token={TOKEN}")
        with pytest.raises(InvalidStatus, match="401"):
            Client(program.address, ssl=trusting)
        for address, context in (
            (f"{program.address}/?token={TOKEN}", trusting),
            (program.address, with_key),
        ):
            with Client(address, ssl=context) as client:
                assert client.get_parameters("/talker.depth") == {"/talker.depth": 3}
        with pytest.raises(REFUSED):
            Client(program.address)  # not encrypted


def test_tls_1_3_serves_the_page(
    other_users: None, keys: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_SECURITY", str(keys / "robot"))
    monkeypatch.setenv("NAVETTE_VIEW_TOKEN", TOKEN)
    context = ssl.create_default_context(cafile=keys / "ca.pem")
    context.minimum_version = ssl.TLSVersion.TLSv1_3
    with Program(talker, host="0.0.0.0") as program:
        address = f"https://{program.address}/health?token={TOKEN}"
        with urllib.request.urlopen(address, context=context) as health:
            assert json.load(health)["status"] == "ok"


def test_certificates_of_another_authority_are_refused(
    other_users: None, keys: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_SECURITY", str(keys / "robot"))
    create_keys(tmp_path, ["thief"], now=NOW)
    context = client_tls(keys)
    context.load_cert_chain(tmp_path / "thief/cert.pem", tmp_path / "thief/key.pem")
    with Program(talker, host="0.0.0.0") as program, pytest.raises(REFUSED):
        Client(program.address, ssl=context)
