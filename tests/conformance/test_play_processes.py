"""A bag played to another process, and to programs in the same process."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "transports"))

from transport_pairs import LIMIT_S, zenoh_environment

from free_ports import free_endpoint
from navette.bags import BagWriter, OfferedQos, qos_text
from navette.msgs import definition_text, serialize
from navette.msgs.std_msgs.msg import String

pytestmark = pytest.mark.long

S = 1_000_000_000
COUNT = 200

LISTENER = """
import sys
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, DurabilityPolicy
from std_msgs.msg import String

LAST = sys.argv[1]


class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.received = []
        self.create_subscription(String, "map", self.show, latched)
        self.create_subscription(String, "chatter", self.receive, 1000)

    def show(self, msg):
        print("map", msg.data, flush=True)

    def receive(self, msg):
        self.received.append(int(msg.data))
        if msg.data == LAST:
            print("received", len(self.received), self.received[0], flush=True)


def main():
    rclpy.init()
    node = Listener()
    print("ready", flush=True)
    try:
        rclpy.spin(node)
    except rclpy.executors.ExternalShutdownException:
        pass


if __name__ == "__main__":
    main()
"""


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """A map published once, and 200 numbers in 20 s."""
    path = tmp_path / "talk.mcap"
    writer = BagWriter(path)
    kind = "std_msgs/msg/String"
    durability = {"/map": "transient_local", "/chatter": "volatile"}
    numbers = {
        topic: writer.add_channel(
            topic,
            kind,
            definition_text(kind),
            qos=qos_text([OfferedQos(depth=1, durability=each)]),
        )
        for topic, each in durability.items()
    }
    writer.write(numbers["/map"], 100 * S, serialize(String(data="of the world")))
    for i in range(COUNT):
        data = serialize(String(data=f"{i}"))
        writer.write(numbers["/chatter"], 100 * S + i * S // 10, data)
    writer.close()
    return path


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "listener.py"
    path.write_text(LISTENER)
    return path


@pytest.fixture
def start() -> Iterator["Starter"]:
    with ExitStack() as stack:
        yield Starter(stack)


class Starter:
    """Starts commands on their own network, and ends the remaining ones."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._environment = zenoh_environment(free_endpoint())

    def __call__(self, *words: object) -> "subprocess.Popen[str]":
        process = subprocess.Popen(
            [sys.executable, "-m", "navette", *map(str, words)],
            env=self._environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._stack.callback(self._end, process)
        return process

    @staticmethod
    def _end(process: "subprocess.Popen[str]") -> None:
        if process.poll() is None:
            process.kill()
        process.communicate(timeout=LIMIT_S)


def line_of(process: "subprocess.Popen[str]") -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


@pytest.mark.slow
def test_another_process_receives_every_message(
    start: Starter, bag: Path, program: Path
) -> None:
    listener = start("run", program, COUNT - 1)
    assert line_of(listener) == "ready"
    player = start("bag", "play", bag, "-r", "20")
    assert line_of(listener) == "map of the world"
    assert line_of(listener) == f"received {COUNT} 0"
    assert player.wait(LIMIT_S) == 0


@pytest.mark.slow
def test_a_late_process_receives_latched_messages(
    start: Starter, bag: Path, program: Path
) -> None:
    player = start("bag", "play", bag, "-s", "10", "--pause")
    assert player.stderr is not None
    assert player.stderr.readline().startswith("Playing")
    listener = start("run", program, COUNT - 1)
    assert sorted((line_of(listener), line_of(listener))) == [
        "map of the world",
        "ready",
    ]


@pytest.mark.slow
def test_programs_run_in_the_same_process(
    start: Starter, bag: Path, program: Path
) -> None:
    player = start("bag", "play", bag, "-r", "20", "--with", f"{program} {COUNT - 1}")
    out, err = player.communicate(timeout=LIMIT_S)
    assert sorted(out.split("\n")) == [
        "",
        "map of the world",
        "ready",
        f"received {COUNT} 0",
    ]
    assert player.returncode == 0, err
    assert "played: 201 messages" in err
