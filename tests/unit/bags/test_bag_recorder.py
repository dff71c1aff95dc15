"""The recorder: topics, reproducible bytes, and a failing disk."""

import errno
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from navette.bags import BagWriter, open_bag
from navette.bags.node import RecorderNode
from navette.errors import FileFormatError, ParameterError
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import Image, LaserScan
from navette.msgs.std_msgs.msg import Float64, String
from navette.runtime import Context, Executor, Node, Parameter, VirtualClock
from navette.runtime.qos import (
    QoSDurabilityPolicy,
    QoSProfile,
    qos_profile_sensor_data,
)
from navette.runtime.testing import GraphHarness

SECOND = 1_000_000_000
LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


class Robot(Node):
    """A noisy scan, a latched map, a camera; another publisher after one second."""

    def __init__(self, context: Context, seed: int) -> None:
        super().__init__("robot", context=context)
        self.random = np.random.default_rng(seed)
        self.scan = self.create_publisher(LaserScan, "/lidar", qos_profile_sensor_data)
        self.camera = self.create_publisher(Image, "/camera", 10)
        self.map = self.create_publisher(OccupancyGrid, "/map", LATCHED)
        self.map.publish(OccupancyGrid(data=np.zeros(1000, np.int8)))
        self.create_timer(0.1, self.on_scan)
        self.late = self.create_timer(1.0, self.on_late)
        self.ticks = 0

    def on_scan(self) -> None:
        self.ticks += 1
        self.scan.publish(LaserScan(ranges=self.random.uniform(1, 20, 64)))
        if self.camera.get_subscription_count():
            self.camera.publish(Image(data=np.zeros(100, np.uint8)))

    def on_late(self) -> None:
        self.late.cancel()
        self.get_logger().info("a second voice")
        voice = self.create_publisher(String, "/voice", 10)
        self.create_timer(0.5, lambda: voice.publish(String(data="hm")))


class Run:
    """A robot and its recorder under virtual time."""

    def __init__(self, path: Path, *, seed: int = 1, **params: object) -> None:
        self.context = Context(clock=VirtualClock())
        self.executor = Executor(context=self.context)
        self.robot = Robot(self.context, seed)
        overrides = [Parameter(name, value=value) for name, value in params.items()]
        self.recorder = RecorderNode(
            path, context=self.context, parameter_overrides=overrides
        )
        self.executor.add_node(self.robot)
        self.executor.add_node(self.recorder)

    def go(self, seconds: float) -> "Run":
        self.executor.spin_for(round(seconds * SECOND))
        return self

    def end(self) -> None:
        self.recorder.close()
        self.context.shutdown()


def counts(path: Path) -> dict[str, int]:
    """Return the number of messages by topic."""
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    by_channel = summary.statistics.channel_message_counts
    return {c.topic: by_channel.get(c.id, 0) for c in summary.channels.values()}


def test_everything_but_images_is_recorded(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    run = Run(path).go(3)
    assert run.recorder.message_count > 30
    run.end()
    found = counts(path)
    assert found["/lidar"] == 30
    assert found["/map"] == 1
    assert found["/voice"] == 4
    assert found["/rosout"] == 1
    assert "/camera" not in found


def test_a_camera_is_recorded_only_on_request(tmp_path: Path) -> None:
    run = Run(tmp_path / "a.mcap").go(1)
    assert run.robot.camera.get_subscription_count() == 0
    run.end()
    Run(tmp_path / "b.mcap", images=True).go(1).end()
    assert counts(tmp_path / "b.mcap")["/camera"] == 10


def test_topics_are_chosen_by_name_and_pattern(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    Run(path, topics=["/map"], regex="^/v").go(3).end()
    assert set(counts(path)) == {"/map", "/voice"}
    other = tmp_path / "b.mcap"
    Run(other, exclude="map|ros|param").go(3).end()
    assert set(counts(other)) == {"/lidar", "/voice"}


def test_topics_can_be_added_while_recording(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    run = Run(path, topics=["/map"]).go(1)
    (result,) = run.recorder.set_parameters([Parameter("regex", value="lidar")])
    assert result.successful
    (result,) = run.recorder.set_parameters([Parameter("flush_period_s", value=0.1)])
    assert result.successful
    run.go(1).end()
    assert counts(path) == {"/map": 1, "/lidar": 10}


def test_messages_older_than_half_a_second_are_on_disk(tmp_path: Path) -> None:
    run = Run(tmp_path / "a.mcap").go(3.0)
    with open_bag(tmp_path / "a.mcap") as reader:  # as who is killed leaves it
        kept = reader.messages(["/lidar"], on_damage=lambda damage: None)
        last = [message.stamp_ns for message in kept][-1]
    assert run.context.clock.now_ns - last <= SECOND // 2
    run.end()


def test_the_same_run_gives_the_same_bytes(tmp_path: Path) -> None:
    runs = {"a": 1, "b": 1, "other seed": 2}
    for name, seed in runs.items():
        Run(tmp_path / f"{name}.mcap", seed=seed).go(5).end()
    a, b, other = ((tmp_path / f"{name}.mcap").read_bytes() for name in runs)
    assert a == b
    assert a != other


def test_stamps_are_the_nodes_clock_and_qos_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    Run(path).go(1).end()
    with path.open("rb") as file:
        reader = make_reader(file)
        found = list(reader.iter_messages(topics=["/lidar"]))
        qos = {
            channel.topic: channel.metadata["offered_qos_profiles"]
            for channel in reader.get_summary().channels.values()
        }
    assert [m.log_time for _, _, m in found] == [
        round(0.1 * SECOND) * n for n in range(1, 11)
    ]
    assert [m.sequence for _, _, m in found] == list(range(1, 11))
    assert "reliability: best_effort" in qos["/lidar"]
    assert "durability: transient_local" in qos["/map"]


def test_a_file_that_cannot_be_created_leaves_no_node(tmp_path: Path) -> None:
    context = Context(clock=VirtualClock())
    with pytest.raises(FileFormatError, match="cannot be written"):
        RecorderNode(tmp_path / "no" / "a.mcap", context=context)
    assert context.nodes == []
    context.shutdown()


def test_a_name_of_another_format_is_refused(tmp_path: Path) -> None:
    for name in ("run.db3", "run"):
        with (
            Context(clock=VirtualClock()) as context,
            pytest.raises(FileFormatError, match=r"name that ends in \.mcap"),
        ):
            RecorderNode(tmp_path / name, context=context)
    assert list(tmp_path.iterdir()) == []


def test_a_refused_parameter_creates_no_file(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with pytest.raises(ParameterError, match="flush_period_s"):
        Run(path, flush_period_s=-1.0)
    assert not path.exists()


def test_a_full_disk_ends_the_recording_not_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.mcap"
    run = Run(path).go(2)
    recorded = run.recorder.message_count

    def fail(_writer: BagWriter) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(BagWriter, "flush", fail)
    run.go(2)
    assert run.robot.ticks == 40
    assert "a.mcap: recording ended: No space left on device" in str(run.recorder.error)
    assert run.recorder.message_count < recorded + 10
    run.end()


def test_closing_twice_has_no_effect(tmp_path: Path) -> None:
    run = Run(tmp_path / "a.mcap").go(1)
    run.recorder.close()
    run.recorder.close()
    run.go(1)
    run.end()
    assert run.recorder.error is None


def test_a_topic_with_two_types_is_recorded(tmp_path: Path) -> None:
    """As /cmd_vel: subscriptions for Twist and TwistStamped in another process."""
    with GraphHarness() as graph:
        kinds = (String, Float64)
        for kind, other in (kinds, kinds[::-1]):
            graph.node.create_subscription(
                kind, "t", lambda msg: None, 10, other_types=[other]
            )
        recorder = graph.add(RecorderNode(tmp_path / "b.mcap", context=graph.context))
        graph.run_for(0.1)
        for publisher in list(graph.node.subscriptions):
            publisher.destroy()  # then only the recorder's own subscriptions remain
        graph.run_for(0.1)
        graph.publish("t", Float64(data=1.0))
        graph.run_for(0.1)
        recorder.destroy_node()
    with open_bag(tmp_path / "b.mcap") as bag:
        assert [m.topic.type_name for m in bag.messages(["/t"])] == [
            "std_msgs/msg/Float64"
        ]
