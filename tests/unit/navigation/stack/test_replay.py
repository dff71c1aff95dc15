"""Replay of recorded inputs: topics, order and time."""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from navette.bags import BagWriter, OfferedQos, open_bag, qos_text
from navette.bags.play import PlayOptions
from navette.cli.app import app
from navette.errors import InvalidValueError, ParameterError, UnknownNameError
from navette.msgs import (
    definition_text,
    deserialize,
    get_interface,
    serialize,
    type_name,
)
from navette.msgs.std_msgs.msg import Float64, String
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.stack.replay import Replay, ReplaySummary
from navette.navigation.stack.stage_classes import node_class
from navette.ros2.names import is_installed, uninstall
from navette.ros2.names.node_classes import load_node_class
from navette.runtime import Context, DurabilityPolicy, Node, QoSProfile

S = 1_000_000_000
START = 1_700_000_000 * S + 123_456_789
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

PROGRAM = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Summer(Node):
    def __init__(self):
        super().__init__("summer")
        self.total = self.declare_parameter("start", 0.0).value
        self.create_subscription(Float64, "number", self.on_message, 10)
        self.publisher = self.create_publisher(Float64, "total", 10)
        self.create_timer(0.5, self.on_timer)

    def on_message(self, msg):
        self.total += msg.data

    def on_timer(self):
        self.publisher.publish(Float64(data=self.total))


class Nothing:
    pass
"""


def write(
    path: Path, messages: list[tuple[str, float, Any]], latched: str = ""
) -> Path:
    writer = BagWriter(path)
    numbers: dict[str, int] = {}
    for topic, after_s, message in messages:
        kind = type_name(type(message))
        if topic not in numbers:
            durability = "transient_local" if topic == latched else "volatile"
            numbers[topic] = writer.add_channel(
                topic,
                kind,
                definition_text(kind),
                qos=qos_text([OfferedQos(durability=durability)]),
            )
        stamp_ns = START + round(after_s * S)
        writer.write(numbers[topic], stamp_ns, serialize(message))
    writer.close()
    return path


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """A number every 0.2 s for 2 s, and a recorded total."""
    messages = [("/number", i / 5, Float64(data=1.0)) for i in range(11)]
    messages += [("/total", 2.0, Float64(data=-1.0))]
    return write(tmp_path / "in.mcap", messages)


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    monkeypatch.setattr(sys, "path", [*sys.path])
    path = tmp_path / "summer_program.py"
    path.write_text(PROGRAM)
    yield f"{path}:Summer"
    sys.modules.pop("summer_program", None)


@pytest.fixture(autouse=True)
def without_traces() -> Iterator[None]:
    """Remove the ROS 2 module names that programs install."""
    was_installed = is_installed()
    yield
    if not was_installed:
        uninstall()


def recorded_in(path: Path) -> dict[str, list[tuple[float, Any]]]:
    found: dict[str, list[tuple[float, Any]]] = {}
    with open_bag(path) as source:
        for message in source.messages():
            value = deserialize(message.data, get_interface(message.topic.type_name))
            after_s = (message.stamp_ns - START) / S
            found.setdefault(message.topic.name, []).append((after_s, value.data))
    return found


def replay(path: Path, make: Any, **more: Any) -> ReplaySummary:
    with open_bag(path) as source:
        replayed = Replay(source, [make], **more)
        try:
            return replayed.run()
        finally:
            replayed.close()


def test_an_rclpy_program_runs_in_the_time_of_the_recording(
    bag: Path, program: str, tmp_path: Path
) -> None:
    kind: Any = load_node_class(program)
    out = tmp_path / "out.mcap"
    summary = replay(bag, lambda context: kind(), record=out)
    assert summary.inputs == ("/number",)
    assert summary.outputs == ("/total",)
    assert summary.fed == 11
    assert recorded_in(out) == {
        "/total": [(0.5, 3.0), (1.0, 5.0), (1.5, 8.0), (2.0, 10.0)]
    }


def test_a_time_range_is_replayed(bag: Path, program: str, tmp_path: Path) -> None:
    kind: Any = load_node_class(program)
    out = tmp_path / "out.mcap"
    options = PlayOptions(start_offset_s=1.0, duration_s=0.6)
    assert replay(bag, lambda c: kind(), record=out, options=options).fed == 4
    assert recorded_in(out) == {"/total": [(1.5, 3.0)]}


def test_parameters_reach_the_nodes(bag: Path, program: str, tmp_path: Path) -> None:
    kind: Any = load_node_class(program)
    out = tmp_path / "out.mcap"
    words = ["--ros-args", "-p", "summer:start:=100.0"]
    replay(bag, lambda c: kind(), record=out, arguments=words)
    assert recorded_in(out)["/total"][0] == (0.5, 103.0)
    with pytest.raises(ParameterError, match="no node matches 'planner'"):
        replay(bag, lambda c: kind(), arguments=["--ros-args", "-p", "planner:a:=1"])


class Listener(Node):
    """Stores the received messages and their times."""

    def __init__(self, context: Context, *topics: str, late: str = "") -> None:
        super().__init__("listener", context=context)
        self.received: list[tuple[int, str, str]] = []
        for topic in topics:
            self.listen(topic)
        if late:
            self.create_timer(0.5, lambda: self.listen(late))

    def listen(self, topic: str) -> None:
        self.create_subscription(
            String, topic, lambda m: self.on_message(topic, m.data), LATCHED
        )

    def on_message(self, topic: str, text: str) -> None:
        self.received.append((self.get_clock().now().nanoseconds - START, topic, text))


def test_latched_inputs_come_before_a_later_start(tmp_path: Path) -> None:
    messages: list[tuple[str, float, Any]] = [("/map", 0.0, String(data="map"))]
    messages += [("/chatter", float(i), Float64()) for i in range(5)]
    path = write(tmp_path / "in.mcap", messages, latched="/map")
    listeners: list[Listener] = []

    def make(context: Context) -> Node:
        listeners.append(Listener(context, "/map"))
        return listeners[-1]

    replay(path, make, options=PlayOptions(start_offset_s=3.0))
    assert listeners[0].received == [(3 * S, "/map", "map")]


def test_late_subscriptions_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    messages = [(t, i / 5, String(data="x")) for i in range(9) for t in ("/a", "/b")]
    path = write(tmp_path / "in.mcap", messages)
    nodes: list[Listener] = []

    def make(context: Context) -> Node:
        nodes.append(Listener(context, "/a", late="/b"))
        return nodes[-1]

    assert replay(path, make).inputs == ("/a",)
    assert "add --input /b" in capsys.readouterr().err
    assert set(replay(path, make, also=["/b"]).inputs) == {"/a", "/b"}


def test_invalid_combinations_are_named(bag: Path, tmp_path: Path) -> None:
    with pytest.raises(
        InvalidValueError, match="no input was recorded: the nodes read"
    ):
        replay(bag, lambda context: Listener(context, "/other"))
    path = write(tmp_path / "t.mcap", [("/tf_static", 0.0, TFMessage())])
    with pytest.raises(InvalidValueError, match="no input was recorded"):
        replay(path, lambda context: Listener(context, "/other"))
    path = write(tmp_path / "s.mcap", [("/s", 0.0, String())])
    with pytest.raises(InvalidValueError, match="listener publishes nothing"):
        replay(path, lambda c: Listener(c, "/s"), record=tmp_path / "out.mcap")
    with pytest.raises(UnknownNameError, match=r"stage 'plan'; known: .*planner"):
        node_class("plan")


@pytest.mark.parametrize(
    ("target", "reason"),
    [
        ("nowhere.py:Summer", "nowhere.py: no such file"),
        ("no_such_module_here:Summer", "is not installed and not in"),
        ("{file}:Winter", "known: Summer"),
        ("{file}:Nothing", "known: Summer"),
    ],
)
def test_missing_programs_are_named(target: str, reason: str, program: str) -> None:
    with pytest.raises(UnknownNameError, match=reason):
        load_node_class(target.format(file=program.rpartition(":")[0]))


def test_an_error_of_the_program_is_in_one_line(tmp_path: Path) -> None:
    file = tmp_path / "broken.py"
    file.write_text("def (:", encoding="utf-8")
    with pytest.raises(InvalidValueError, match="imported: SyntaxError"):
        load_node_class(str(file))


@pytest.mark.parametrize("target", ["summer", ":Summer", "a.py:", "a.py:b-c"])
def test_other_forms_are_refused(target: str) -> None:
    with pytest.raises(InvalidValueError, match="expected MODULE:Class"):
        load_node_class(target)


# -- the command -------------------------------------------------------------------


def command(*words: object) -> Any:
    return CliRunner().invoke(app, ["bag", "replay", *map(str, words)])


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A drive of a simulated robot, with everything recorded."""
    path = tmp_path_factory.mktemp("drive") / "drive.mcap"
    words = ["sim", "arena", "--goal", "1,0", "--headless", "--record", str(path)]
    ended = CliRunner().invoke(app, [*words, "--max-time", "2.0"])
    assert path.exists(), ended.output
    return path


@pytest.mark.parametrize(
    ("stage", "line"),
    [
        ("missions", "not compared: /path: other nodes published there too"),
        ("arbiter", "✓  /commander"),
        ("tracking", "no messages of these nodes to compare"),
    ],
)
def test_a_stage_that_depends_on_the_graph_repeats_an_unmodified_recording(
    drive: Path, stage: str, line: str
) -> None:
    ended = command(drive, "--node", stage, "--compare", drive)
    assert ended.exit_code == 0, ended.output
    assert line in ended.stdout


def test_the_command_compares(bag: Path, program: str, tmp_path: Path) -> None:
    golden = tmp_path / "golden.mcap"
    made = command(bag, "--node", program, "--record", golden)
    assert made.exit_code == 0, made.output
    same = command(bag, "--node", program, "--compare", golden)
    assert same.exit_code == 0, same.output
    assert [line.split() for line in same.stdout.splitlines()] == [
        ["topic", "compared", "differ", "missing", "extra"],
        ["✓", "/total", "4", "0", "0", "0"],
    ]
    words = (bag, "--node", program, "--compare", golden, "-p", "start:=0.25")
    other = command(*words)
    assert other.exit_code == 1
    assert "data" in other.stdout
    assert "3 → 3.25" in other.stdout
    assert command(*words, "--tolerance", "/total=0.3").exit_code == 0


def test_the_command_prints_json(bag: Path, program: str, tmp_path: Path) -> None:
    golden = tmp_path / "golden.mcap"
    command(bag, "--node", program, "--record", golden)
    words = (bag, "--node", program, "--compare", golden, "-p", "start:=1.0", "--json")
    document = json.loads(command(*words).stdout)
    assert document["same"] is False
    (topic,) = document["topics"]
    assert (topic["topic"], topic["differing"]) == ("/total", 4)
    assert topic["fields"][0]["largest"] == 1.0


def test_the_command_does_not_overwrite_its_input(bag: Path, program: str) -> None:
    before = bag.read_bytes()
    refused = command(bag, "--node", program, "--record", bag)
    assert isinstance(refused.exception, InvalidValueError)
    assert bag.read_bytes() == before
