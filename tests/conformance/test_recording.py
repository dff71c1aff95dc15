"""Recordings read by other readers, and after a real kill."""

import os
import signal
import subprocess
import sys
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability

from navette.bags.node import RecorderNode
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime import Context, Executor, Node, VirtualClock
from navette.runtime.qos import QoSDurabilityPolicy, QoSProfile

LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
SECOND = 1_000_000_000


class Robot(Node):
    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        self.odometry = self.create_publisher(Odometry, "/odom/filtered", 10)
        self.create_publisher(TFMessage, "/tf_static", LATCHED).publish(TFMessage())
        grid = OccupancyGrid(header=Header(frame_id="map"))
        grid.data = np.array([0, 100, -1], np.int8)
        self.create_publisher(OccupancyGrid, "/map", LATCHED).publish(grid)
        self.step = 0
        self.create_timer(0.05, self.on_timer)

    def on_timer(self) -> None:
        self.step += 1
        odometry = Odometry(header=Header(frame_id="odom"), child_frame_id="base")
        odometry.pose.pose.position.x = 0.5 * self.step
        self.odometry.publish(odometry)


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("bags") / "run.mcap"
    context = Context(clock=VirtualClock())
    executor = Executor(context=context)
    executor.add_node(Robot(context))
    recorder = RecorderNode(path, context=context)
    executor.add_node(recorder)
    executor.spin_for(2 * SECOND)
    recorder.close()
    context.shutdown()
    return path


def test_mcap_ros2_reads_every_message(bag: Path) -> None:
    found: dict[str, list[Any]] = {}
    with bag.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    odometry = found["/odom/filtered"]
    positions = [decoded.pose.pose.position.x for _, decoded in odometry]
    assert positions == [0.5 * n for n in range(1, 41)]
    assert [stamp for stamp, _ in odometry] == [SECOND // 20 * n for n in range(1, 41)]
    assert found["/map"][0][1].data == [0, 100, -1]


def test_rosbags_reads_every_message(bag: Path) -> None:
    with AnyReader([bag]) as reader:
        assert reader.end_time >= 2 * SECOND
        found: Counter[str] = Counter()
        for connection, _, raw in reader.messages():
            message: Any = reader.deserialize(raw, connection.msgtype)
            found[connection.topic] += 1
            if connection.topic == "/map":
                assert message.data.tolist() == [0, 100, -1]
                assert message.header.frame_id == "map"
        connections = {c.topic: c for c in reader.connections}
    assert found["/odom/filtered"] == 40
    assert found["/map"] == found["/tf_static"] == 1
    (offered,) = connections["/map"].ext.offered_qos_profiles
    assert offered.durability == QosDurability.TRANSIENT_LOCAL
    assert offered.depth == 1
    assert connections["/map"].msgtype == "nav_msgs/msg/OccupancyGrid"


# Publishes endlessly at full speed in virtual time; prints each simulated second.
TALKER = """
import sys
from navette.bags.node import RecorderNode
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Executor, Node, VirtualClock

context = Context(clock=VirtualClock())
executor = Executor(context=context)
node = Node("talker", context=context)
publisher = node.create_publisher(String, "/chatter", 10)
count = 0

def talk():
    global count
    count += 1
    publisher.publish(String(data=str(count)))

node.create_timer(0.01, talk)
executor.add_node(node)
executor.add_node(RecorderNode(sys.argv[1], context=context))
while True:
    executor.spin_for(1_000_000_000)
    print(count, flush=True)
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL on Windows")
def test_a_killed_process_leaves_a_readable_file(tmp_path: Path) -> None:
    path = tmp_path / "killed.mcap"
    with subprocess.Popen(
        [sys.executable, "-c", TALKER, str(path)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        for _ in range(3):
            printed = int(process.stdout.readline())
        process.send_signal(signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL

    words = [data.decode() for data in chatter_of(path)]
    recorded = [int(word) for word in words]
    assert recorded == list(range(1, len(recorded) + 1)), "no gaps"
    # At most 0.25 s of a 100 Hz topic may be lost.
    assert len(recorded) >= printed - 25


def chatter_of(path: Path) -> list[bytes]:
    """Return the strings of an unfinished file, read without an index."""
    found: list[bytes] = []
    with path.open("rb") as file, suppress(EndOfFile):
        reader = NonSeekingReader(file)
        for _, _, message in reader.iter_messages("/chatter", log_time_order=False):
            found.append(message.data[8:-1])
    return found
