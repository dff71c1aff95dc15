"""Access control: certificates, passwords, access rules."""

import datetime
import json
import logging
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from transport_pairs import until

from free_ports import free_endpoint
from navette.errors import FileFormatError, InvalidValueError
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Executor, Node, SystemClock
from navette.transports.certificates import create_keys
from navette.transports.zenoh.security import Security
from navette.transports.zenoh.settings import Settings

pytestmark = pytest.mark.long

NOW = datetime.datetime.fromtimestamp(SystemClock().now_ns / 1e9, datetime.UTC)


class Machine:
    """A node that publishes and subscribes on /chatter, with its own settings."""

    def __init__(self, name: str) -> None:
        self.context = Context(transport="zenoh")
        self.context.init(args=[], initialize_logging=False)
        self.node = Node(name, context=self.context)
        self.publisher = self.node.create_publisher(String, "/chatter", 10)
        self.received: list[str] = []
        self.node.create_subscription(String, "/chatter", self.receive, 10)
        self.executor = Executor(context=self.context)
        self.executor.add_node(self.node)

    def receive(self, message: String) -> None:
        self.received.append(message.data)

    def sees(self, other: "Machine") -> bool:
        self.executor.spin_once(timeout_sec=0.0)
        name = other.node.get_fully_qualified_name()
        return name in {info.full_name for info in self.context.graph.nodes()}


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> Iterator["Network"]:
    with ExitStack() as stack:
        yield Network(monkeypatch, stack)


class Network:
    """Machines that expect their router at the same free port."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, stack: ExitStack) -> None:
        self._address = free_endpoint().partition("/")[2]
        self._monkeypatch = monkeypatch
        self._stack = stack

    def join(self, name: str, folder: Path | None, *, protocol: str) -> Machine:
        self._monkeypatch.setenv("NAVETTE_ROUTER", f"{protocol}/{self._address}")
        self._monkeypatch.setenv("NAVETTE_LISTEN", f"{protocol}/127.0.0.1:0")
        self._monkeypatch.setenv("NAVETTE_SECURITY", str(folder or ""))
        machine = Machine(name)
        self._stack.callback(machine.context.try_shutdown)
        return machine


def exchange(sender: Machine, receiver: Machine) -> None:
    """Publish until a message of the sender reaches the receiver."""

    def check() -> bool:
        sender.publisher.publish(String(data=sender.node.get_name()))
        receiver.executor.spin_once(timeout_sec=0.001)
        return sender.node.get_name() in receiver.received

    until(check, f"{receiver.node.get_name()} receives {sender.node.get_name()}")


def assert_apart(outsider: Machine, insider: Machine, other: Machine) -> None:
    """Check that the outsider is isolated while the other two communicate."""
    outsider.publisher.publish(String(data=outsider.node.get_name()))
    insider.received.clear()
    other.received.clear()
    exchange(insider, other)
    exchange(other, insider)
    outsider.executor.spin_once(timeout_sec=0.0)
    assert not outsider.sees(insider)
    assert not insider.sees(outsider)
    assert set(outsider.received) <= {outsider.node.get_name()}
    assert outsider.node.get_name() not in insider.received + other.received


@pytest.mark.slow
def test_only_certificates_of_the_same_authority_are_accepted(
    network: Network, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    robot, laptop = create_keys(tmp_path / "ours", ["robot", "laptop"], now=NOW)
    (foreign,) = create_keys(tmp_path / "theirs", ["robot"], now=NOW)
    a = network.join("robot", robot, protocol="tls")
    b = network.join("laptop", laptop, protocol="tls")
    exchange(a, b)
    exchange(b, a)
    with caplog.at_level(logging.WARNING, logger="navette"):
        c = network.join("foreign", foreign, protocol="tls")
    assert "does not accept this process" in caplog.text
    assert_apart(c, a, b)
    caplog.clear()
    with caplog.at_level(logging.WARNING, logger="navette"):
        d = network.join("plain", None, protocol="tcp")
    assert "does not accept this process" in caplog.text
    assert_apart(d, a, b)


@pytest.mark.slow
def test_an_expired_certificate_is_refused(network: Network, tmp_path: Path) -> None:
    folder = tmp_path / "ours"
    robot, laptop = create_keys(folder, ["robot", "laptop"], now=NOW)
    long_ago = NOW - datetime.timedelta(days=30)
    (old,) = create_keys(folder, ["old"], now=long_ago, days=7)
    a = network.join("robot", robot, protocol="tls")
    b = network.join("laptop", laptop, protocol="tls")
    exchange(a, b)
    assert_apart(network.join("old", old, protocol="tls"), a, b)


def login(folder: Path, name: str, password: str, users: str) -> Path:
    folder.mkdir()
    (folder / "login").write_text(f"{name}:{password}\n")
    (folder / "users").write_text(users)
    return folder


@pytest.mark.slow
def test_a_wrong_password_is_refused(network: Network, tmp_path: Path) -> None:
    users = "robot:steel\nlaptop:paper\n"
    robot = login(tmp_path / "a", "robot", "steel", users)
    laptop = login(tmp_path / "b", "laptop", "paper", users)
    guess = login(tmp_path / "c", "laptop", "glass", users)
    a = network.join("robot", robot, protocol="tcp")
    b = network.join("laptop", laptop, protocol="tcp")
    exchange(a, b)
    exchange(b, a)
    assert_apart(network.join("guess", guess, protocol="tcp"), a, b)
    assert_apart(network.join("anonymous", None, protocol="tcp"), a, b)


ONLY_LISTEN = {
    "enabled": True,
    "default_permission": "allow",
    "rules": [
        {
            "id": "chatter",
            "permission": "deny",
            "messages": ["put", "reply"],
            "flows": ["ingress"],
            "key_exprs": ["*/chatter/**"],
        }
    ],
    "subjects": [{"id": "guests", "cert_common_names": ["guest"]}],
    "policies": [{"rules": ["chatter"], "subjects": ["guests"]}],
}


@pytest.mark.slow
@pytest.mark.parametrize("retransmit", ["", "/chatter"])
def test_access_rules_keep_a_guest_from_publishing(
    network: Network,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    retransmit: str,
) -> None:
    """Also where the subscription queries the guest for missed samples."""
    monkeypatch.setenv("NAVETTE_RETRANSMIT", retransmit)
    robot, laptop, guest = create_keys(
        tmp_path / "keys", ["robot", "laptop", "guest"], now=NOW
    )
    for folder in (robot, laptop):
        (folder / "access.json5").write_text(json.dumps(ONLY_LISTEN))
    a = network.join("robot", robot, protocol="tls")
    b = network.join("laptop", laptop, protocol="tls")
    c = network.join("guest", guest, protocol="tls")
    exchange(a, c)  # the guest may subscribe
    for _ in range(20):
        c.publisher.publish(String(data="guest"))
        a.received.clear()
        exchange(b, a)
        assert "guest" not in a.received


def test_certificates_change_the_default_endpoints_to_tls(tmp_path: Path) -> None:
    (robot,) = create_keys(tmp_path / "keys", ["robot"], now=NOW)
    settings = Settings.from_environment({"NAVETTE_SECURITY": str(robot)})
    assert settings.router == ("tls/127.0.0.1:7447",)
    assert settings.listen == ("tls/127.0.0.1:0",)


def test_a_plain_endpoint_beside_certificates_is_refused(
    network: Network, tmp_path: Path
) -> None:
    (robot,) = create_keys(tmp_path / "keys", ["robot"], now=NOW)
    with pytest.raises(InvalidValueError, match="must begin with tls/"):
        network.join("robot", robot, protocol="tcp")


def test_missing_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="is not a folder"):
        Security(tmp_path / "none")
    with pytest.raises(InvalidValueError, match="no credentials in"):
        Security(tmp_path)
    (robot,) = create_keys(tmp_path / "keys", ["robot"], now=NOW)
    (robot / "key.pem").unlink()
    with pytest.raises(FileFormatError, match=r"key\.pem: missing"):
        Security(robot)
    login(tmp_path / "login", "nocolon", "", "")
    with pytest.raises(FileFormatError, match="name:password"):
        Security(tmp_path / "login").describe()


def test_keys_are_created_once_and_readable_by_their_owner_only(tmp_path: Path) -> None:
    first = create_keys(tmp_path / "keys", ["robot"], now=NOW)[0]
    second = create_keys(tmp_path / "keys", ["laptop"], now=NOW)[0]
    assert (first / "ca.pem").read_bytes() == (second / "ca.pem").read_bytes()
    assert (first / "key.pem").stat().st_mode & 0o077 == 0
    assert (tmp_path / "keys" / "ca.key").stat().st_mode & 0o077 == 0
    assert Security(first).describe() == ["TLS with certificates on both sides"]
    with pytest.raises(InvalidValueError, match="exists already"):
        create_keys(tmp_path / "keys", ["robot"], now=NOW)
    with pytest.raises(InvalidValueError, match="at most 63"):
        create_keys(tmp_path / "keys", ["../x"], now=NOW)
