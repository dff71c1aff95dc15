"""``NAVETTE_SECURITY`` end to end: an attacker beside the robot, and on the wire.

The attacker runs in the network namespace of the robot, so that no firewall and no
loopback address protects it, and may read every packet. It has Zenoh, but no key.
"""

import datetime
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from fleet import Fleet, until
from two_machines import LAPTOP, ROBOT, Machines, why_not

from navette.msgs import type_hash
from navette.runtime import SystemClock
from navette.transports.certificates import create_keys

REASON = why_not()
pytestmark = [pytest.mark.long, pytest.mark.skipif(bool(REASON), reason=REASON)]

ATTACKER = Path(__file__).parent / "attacker.py"
NOW = datetime.datetime.fromtimestamp(SystemClock().now_ns / 1e9, datetime.UTC)
SECRET = "plaintext-of-a-message"
PASSWORDS = ["steel-of-the-robot", "paper-of-the-laptop"]
TEXTS = [SECRET, "chatter", "secret_talker", "std_msgs", *PASSWORDS]
PORT = 7447

TALKER = f"""
import sys
import navette
from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import Trigger

navette.init(args=[])
node = navette.Node("secret_talker_on_" + sys.argv[1])
publisher = node.create_publisher(String, "chatter", 10)
seen_texts = set()

def receive(message):
    if message.data not in seen_texts:
        seen_texts.add(message.data)
        print("received", message.data, flush=True)

def unlock(request, response):
    print("unlocked", flush=True)
    return response

node.create_subscription(String, "chatter", receive, 10)
node.create_service(Trigger, "unlock", unlock)
text = "{SECRET} of " + sys.argv[1]
node.create_timer(0.02, lambda: publisher.publish(String(data=text)))
navette.spin(node)
"""


class Scene:
    """A robot and a laptop that talk with their keys, and an attacker's tools."""

    def __init__(self, machines: Machines, fleet: Fleet, folder: Path) -> None:
        self.machines, self.fleet, self.folder = machines, fleet, folder
        (folder / "talker.py").write_text(TALKER)

    def start(self, keys: Mapping[str, Path], protocol: str) -> None:
        """Start a talker on each machine."""
        for name, machine, address in (
            ("robot", self.machines.robot, ROBOT),
            ("laptop", self.machines.laptop, LAPTOP),
        ):
            env = {
                "NAVETTE_SECURITY": str(keys[name]),
                "NAVETTE_ROUTER": f"{protocol}/{ROBOT}:{PORT}",
                "NAVETTE_LISTEN": f"{protocol}/{address}:0",
            }
            prefix = ("ip", "netns", "exec", machine)
            path = str(self.folder / "talker.py")
            self.fleet.start(name, path, name, prefix=prefix, env=env)

    def await_exchange(self) -> None:
        """Wait until each talker receives the other."""
        for name, other in (("robot", "laptop"), ("laptop", "robot")):
            line = f"received {SECRET} of {other}"
            until(
                lambda name=name, line=line: line in self.fleet.output(name),
                f"{name} receives {other}",
            )

    def attack(
        self, attempts: Mapping[str, Any], *, every_port: bool = True
    ) -> dict[str, Any]:
        """Run attempts beside the robot's programs; return what each achieved."""
        string, trigger = "std_msgs/msg/String", "std_srvs/srv/Trigger"
        order = {
            "attempts": attempts,
            "address": ROBOT,
            "port": PORT,
            "every_port": every_port,
            "topic": f"0/chatter/std_msgs::msg::dds_::String_/{type_hash(string)}",
            "service": f"0/unlock/std_srvs::srv::dds_::Trigger_/{type_hash(trigger)}",
        }
        return self._run(self.machines.robot, order)

    def eavesdrop(self, machine: str) -> dict[str, Any]:
        """Read all packets of a machine's devices for two seconds."""
        return self._run(machine, {"seconds": 2.0, "texts": TEXTS})

    def assert_undisturbed(self) -> None:
        """Check that the programs received only each other, and served no request."""
        for name in ("robot", "laptop"):
            words = ("received", "unlocked")
            lines = [x for x in self.fleet.output(name) if x.startswith(words)]
            allowed = {f"received {SECRET} of {end}" for end in ("robot", "laptop")}
            assert set(lines) == allowed

    def impersonated(self, config: dict[str, Any], keys: Mapping[str, Path]) -> Any:
        """Serve as the robot's router, start the talkers; return what they disclose."""
        order = {"impersonate": config, "for_s": 12.0}
        with subprocess.Popen(
            self._command(self.machines.robot),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as router:
            assert router.stdin is not None
            assert router.stdout is not None
            router.stdin.write(json.dumps(order))
            router.stdin.close()
            assert router.stdout.readline() == "serving\n"
            self.start(keys, "tls")
            for name in ("robot", "laptop"):
                until(
                    lambda name=name: (
                        "does not accept this" in "\n".join(self.fleet.output(name))
                    ),
                    f"{name} reports the router",
                )
            return json.loads(router.stdout.readline())

    @staticmethod
    def _command(machine: str) -> list[str]:
        return ["ip", "netns", "exec", machine, sys.executable, str(ATTACKER)]

    @classmethod
    def _run(cls, machine: str, order: dict[str, Any]) -> dict[str, Any]:
        done = subprocess.run(
            cls._command(machine),
            input=json.dumps(order),
            capture_output=True,
            text=True,
            timeout=180.0,
            check=False,
            env={**os.environ, "RUST_LOG": "off"},
        )
        assert done.returncode == 0, done.stderr
        return dict(json.loads(done.stdout))


@pytest.fixture
def scene(tmp_path: Path) -> Iterator[Scene]:
    (tmp_path / "output").mkdir()
    with Machines(seed=1) as machines, Fleet(tmp_path / "output", {}) as fleet:
        yield Scene(machines, fleet, tmp_path)


def keys_of_the_command(folder: Path, *names: str) -> list[Path]:
    """Make keys as a user does."""
    command = [sys.executable, "-m", "navette", "keys", "create", str(folder), *names]
    subprocess.run(command, check=True, capture_output=True)
    return [folder / name for name in names]


def tls(folder: Path, authority: Path) -> dict[str, Any]:
    """Return Zenoh's settings for a certificate and the authority to trust."""
    return {
        "transport/link/tls": {
            "root_ca_certificate": str(authority / "ca.pem"),
            "connect_certificate": str(folder / "cert.pem"),
            "connect_private_key": str(folder / "key.pem"),
            "listen_certificate": str(folder / "cert.pem"),
            "listen_private_key": str(folder / "key.pem"),
            "enable_mtls": True,
            "verify_name_on_connect": False,
        }
    }


def test_without_a_key_nothing_is_reached_and_nothing_is_readable(
    scene: Scene, tmp_path: Path
) -> None:
    robot, laptop = keys_of_the_command(tmp_path / "ours", "robot", "laptop")
    (foreign,) = create_keys(tmp_path / "theirs", ["robot"], now=NOW)
    long_ago = NOW - datetime.timedelta(days=30)
    (old,) = create_keys(tmp_path / "ours", ["old"], now=long_ago, days=7)
    scene.start({"robot": robot, "laptop": laptop}, "tls")
    scene.await_exchange()

    # The attacker has the authority's certificate, which is not secret.
    trusts = {"transport/link/tls": {"root_ca_certificate": str(robot / "ca.pem")}}
    unnamed = {**trusts["transport/link/tls"], "verify_name_on_connect": False}
    kinds = {
        "plain": {"protocol": "tcp", "config": {}},
        "no certificate": {
            "protocol": "tls",
            "config": {"transport/link/tls": unnamed},
        },
        "foreign certificate": {"protocol": "tls", "config": tls(foreign, robot)},
        "expired certificate": {"protocol": "tls", "config": tls(old, robot)},
    }
    attempts = {
        f"{name} {mode}": {**kind, "mode": mode}
        for name, kind in kinds.items()
        for mode in ("client", "peer")
    }
    achieved = scene.attack(attempts)
    assert PORT in achieved["ports"]
    assert len(achieved["ports"]) >= 2  # the router's, and that of the program
    for name, result in achieved["results"].items():
        assert not result["opened"], f"{name}: {result}"
    scene.assert_undisturbed()

    for machine in (scene.machines.robot, scene.machines.laptop):
        seen = scene.eavesdrop(machine)
        assert seen["packets"] > 100
        assert seen["readable"] == dict.fromkeys(TEXTS, 0)

    # The tools work: with a key of the robot, everything is reached.
    insider = {"insider": {"protocol": "tls", "mode": "client"}}
    insider["insider"]["config"] = tls(robot, robot)
    reached = scene.attack(insider, every_port=False)["results"][f"insider {PORT}"]
    assert reached["opened"]
    assert reached["samples"] > 10
    assert reached["tokens"] >= 6
    assert reached["reaches_subscriber"]
    assert reached["reaches_service"]


def test_passwords_keep_the_attacker_out_but_not_from_reading(
    scene: Scene, tmp_path: Path
) -> None:
    keys = {}
    users = dict(zip(("robot", "laptop"), PASSWORDS, strict=True))
    for name, password in users.items():
        keys[name] = tmp_path / f"keys_{name}"
        keys[name].mkdir()
        (keys[name] / "login").write_text(f"{name}:{password}\n")
        lines = [f"{user}:{secret}\n" for user, secret in users.items()]
        (keys[name] / "users").write_text("".join(lines))
    scene.start(keys, "tcp")
    scene.await_exchange()
    guess = {"user": "robot", "password": "steel"}
    attempts = {
        f"{name} {mode}": {"protocol": "tcp", "mode": mode, "config": config}
        for name, config in (
            ("no password", {}),
            ("guess", {"transport/auth/usrpwd": guess}),
        )
        for mode in ("client", "peer")
    }
    achieved = scene.attack(attempts)
    for name, result in achieved["results"].items():
        assert not result["opened"], f"{name}: {result}"
    scene.assert_undisturbed()
    seen = scene.eavesdrop(scene.machines.laptop)
    # As the documentation warns: the messages are readable, the passwords are not.
    assert seen["readable"][SECRET] > 10
    assert [seen["readable"][password] for password in PASSWORDS] == [0, 0]


@pytest.mark.parametrize("protocol", ["tcp", "tls"])
def test_an_attacker_in_the_place_of_the_router_learns_nothing(
    scene: Scene, tmp_path: Path, protocol: str
) -> None:
    robot, laptop = create_keys(tmp_path / "ours", ["robot", "laptop"], now=NOW)
    (foreign,) = create_keys(tmp_path / "theirs", ["robot"], now=NOW)
    config = {"mode": "router", "listen/endpoints": [f"{protocol}/{ROBOT}:{PORT}"]}
    if protocol == "tls":
        config |= tls(foreign, foreign)
        config["transport/link/tls"]["enable_mtls"] = False  # accepts every client
    disclosed = scene.impersonated(config, {"robot": robot, "laptop": laptop})
    assert disclosed == {"peers": 0, "samples": 0, "tokens": 0}
