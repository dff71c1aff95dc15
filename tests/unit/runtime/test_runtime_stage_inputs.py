"""Messages that a stage cannot use: dropped, named, logged once, counted."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from navette.errors import InvalidInputError
from navette.msgs import get_interface
from navette.msgs.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry, Path
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import String
from navette.runtime import Input, MessageInfo, StageNode
from navette.runtime.input_check import SharedInputChecks, input_check
from navette.runtime.testing import GraphHarness


class Listener(StageNode):
    """Accepts odometry and texts other than "bad"."""

    INPUTS = (
        Input(
            topic="/odom",
            type="nav_msgs/msg/Odometry",
            role="pose",
            callback="on_odometry",
            timeout_s=0.5,
        ),
        Input(
            topic="/text",
            type="std_msgs/msg/String",
            role="text",
            callback="on_text",
            timeout_s=0.5,
        ),
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("listener", **kwargs)
        self.received: list[Any] = []
        self.dropped: list[tuple[str, str]] = []

    def on_odometry(self, msg: Odometry) -> None:
        self.received.append(msg)

    def on_text(self, msg: String) -> None:
        if msg.data.startswith("bad"):
            raise InvalidInputError("bad_text", f"data is {msg.data!r}")
        self.received.append(msg)

    def on_input_dropped(self, topic: str, msg: Any, error: InvalidInputError) -> None:
        self.dropped.append((topic, error.reason))


class Numbering(StageNode):
    """Stores the numbers of the texts other than "bad"."""

    INPUTS = (
        Input(
            topic="/text", type="std_msgs/msg/String", role="text", callback="on_text"
        ),
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("numbering", **kwargs)
        self.received: list[tuple[str, int | None]] = []

    def on_text(self, msg: String, info: MessageInfo) -> None:
        if msg.data.startswith("bad"):
            raise InvalidInputError("bad_text", f"data is {msg.data!r}")
        self.received.append((msg.data, info["publication_sequence_number"]))


def odometry(x: float = 0.0) -> Odometry:
    msg = Odometry()
    msg.pose.pose.position.x = x
    return msg


def test_an_invalid_message_is_dropped_logged_once_and_counted() -> None:
    with GraphHarness() as graph:
        node = graph.add(Listener(context=graph.context))
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        for x in (math.nan, math.inf, 1e308, 2.0):
            graph.publish("/odom", odometry(x))
        graph.run_for(0.1)
        assert [msg.pose.pose.position.x for msg in node.received] == [2.0]
        assert node.dropped_inputs == {
            ("/odom", "not_finite"): 2,
            ("/odom", "out_of_range"): 1,
        }
        assert node.dropped == [
            ("/odom", "not_finite"),
            ("/odom", "not_finite"),
            ("/odom", "out_of_range"),
        ]
        assert [log.msg for log in logs.messages] == [
            "refused /odom: not_finite: pose.pose.position.x, y, z = (nan, 0, 0); must "
            "be finite numbers (more of this kind are only counted, on /diagnostics)",
            "refused /odom: out_of_range: pose.pose.position.x, y, z = (1e+308, 0, 0); "
            "must be within ±1e+09 (more of this kind are only counted, on "
            "/diagnostics)",
        ]


def test_a_dropped_message_is_not_an_arrival() -> None:
    with GraphHarness() as graph:
        node = graph.add(Listener(context=graph.context))
        graph.publish("/odom", odometry(math.nan))
        graph.publish("/text", String(data="bad"))
        graph.run_for(0.1)
        assert node.is_stale("/odom")
        assert node.is_stale("/text")
        graph.publish("/odom", odometry())
        graph.publish("/text", String(data="good"))
        graph.run_for(0.3)
        assert not node.is_stale("/odom")
        assert not node.is_stale("/text")
        for _ in range(5):
            graph.publish("/odom", odometry(math.nan))
            graph.publish("/text", String(data="bad"))
            graph.run_for(0.1)
        assert node.is_stale("/odom")
        assert node.is_stale("/text")


def test_counts_are_published_from_the_first_fault_on() -> None:
    with GraphHarness() as graph:
        graph.add(Listener(context=graph.context))
        diagnostics = graph.collect("/diagnostics", DiagnosticArray)
        graph.publish("/odom", odometry())
        graph.run_for(2.0)
        assert diagnostics.count == 0
        for number in range(3):
            graph.publish("/text", String(data=f"bad {number}\x1b[31m"))
        graph.run_for(1.5)
        (status,) = diagnostics.last.status
        assert status.name == "/listener: dropped inputs"
        assert status.level == DiagnosticStatus.WARN
        assert status.message == "3 messages dropped"
        assert [(pair.key, pair.value) for pair in status.values] == [
            ("/text bad_text", "3"),
            ("/text bad_text first", r"bad_text: data is 'bad 0\\x1b[31m'"),
        ]
        graph.run_for(1.0)
        assert diagnostics.last.status[0].level == DiagnosticStatus.OK


def test_bytes_that_are_not_a_message_are_counted() -> None:
    with GraphHarness() as graph:
        node = graph.add(Listener(context=graph.context))
        publisher = graph.node.create_publisher(String, "/text", 10)
        publisher.publish_encoded(b"\0\1\0\0\xff\xff\xff\xff")
        publisher.publish_encoded(b"\0\1\0\0\3\0\0\0\xff\xfe\0")  # not UTF-8
        graph.run_for(0.1)
        assert node.received == []
        assert node.dropped_inputs == {("/text", "undecodable"): 2}


def grid(**info: Any) -> OccupancyGrid:
    msg = OccupancyGrid(data=np.zeros(6, np.int8))
    values = {"width": 3, "height": 2, "resolution": 0.1, **info}
    for name, value in values.items():
        setattr(msg.info, name, value)
    return msg


def scan(**fields: Any) -> LaserScan:
    usual = {"ranges": [1.0, 2.0], "angle_increment": 0.1, "range_max": 10.0}
    return LaserScan(**{**usual, **fields})


def stamped(sec: int, nanosec: int) -> Odometry:
    msg = Odometry()
    msg.header.stamp.sec, msg.header.stamp.nanosec = sec, nanosec
    return msg


def turned(x: float, y: float, z: float, w: float) -> Path:
    pose = PoseStamped(pose=Pose(orientation=Quaternion(x=x, y=y, z=z, w=w)))
    return Path(poses=[PoseStamped(), pose])


@pytest.mark.parametrize(
    ("msg", "reason"),
    [
        (stamped(-1, 0), "invalid_stamp"),
        (stamped(2**31 - 1, 2**32 - 1), "invalid_stamp"),
        (odometry(-math.inf), "not_finite"),
        (odometry(-1e10), "out_of_range"),
        (turned(0.0, 0.0, 0.0, 0.0), "invalid_orientation"),
        (turned(0.0, 0.0, 1.0, 1.0), "invalid_orientation"),
        (turned(0.0, math.nan, 0.0, 1.0), "not_finite"),
        (grid(width=4), "wrong_length"),
        (grid(width=2**32 - 1, height=2**32 - 1), "wrong_length"),
        (grid(resolution=0.0), "out_of_range"),
        (grid(resolution=math.nan), "out_of_range"),
        (OccupancyGrid(), "out_of_range"),
        (scan(ranges=[]), "wrong_length"),
        (scan(ranges=np.zeros(200_000, np.float32)), "wrong_length"),
        (scan(angle_increment=0.0), "out_of_range"),
        (scan(angle_min=math.inf), "not_finite"),
        (scan(range_min=math.nan), "out_of_range"),
        (scan(range_min=11.0), "out_of_range"),
    ],
)
def test_reasons(msg: Any, reason: str) -> None:
    check = input_check(msg._type_name_)
    with pytest.raises(InvalidInputError) as caught:
        check(msg)
    assert caught.value.reason == reason


@pytest.mark.parametrize(
    "msg",
    [
        stamped(0, 0),
        stamped(2**31 - 1, 999_999_999),
        odometry(-1e9),
        turned(0.0, 0.0, 0.70711, 0.70711),
        grid(),
        scan(ranges=[math.nan, math.inf], angle_increment=-0.1),
        scan(range_max=math.inf),
        String(data="\0"),
    ],
)
def test_valid_messages_pass(msg: Any) -> None:
    input_check(msg._type_name_)(msg)


def test_only_the_stamp_is_checked_on_request() -> None:
    check = input_check("nav_msgs/msg/Odometry", contents=False)
    check(odometry(math.nan))
    with pytest.raises(InvalidInputError, match=r"header\.stamp is -1 s"):
        check(stamped(-1, 0))


def test_a_message_that_two_nodes_receive_is_checked_for_both() -> None:
    with GraphHarness() as graph:
        nodes = [
            graph.add(Listener(context=graph.context, namespace=name)) for name in "ab"
        ]
        for x in (1.0, math.nan, 2.0):
            graph.publish("/odom", odometry(x))
        graph.run_for(0.1)
        for node in nodes:
            assert [msg.pose.pose.position.x for msg in node.received] == [1.0, 2.0]
            assert node.dropped_inputs == {("/odom", "not_finite"): 1}


def test_a_shared_check_skips_only_the_message_that_passed_it_last() -> None:
    check = SharedInputChecks().of("nav_msgs/msg/Odometry")
    good, bad = odometry(1.0), odometry(math.nan)
    check(good)
    for _ in range(2):
        with pytest.raises(InvalidInputError):
            check(bad)
    check(good)


def test_a_type_of_a_user_is_checked_by_its_parts() -> None:
    check = input_check("visualization_msgs/msg/Marker")
    marker = get_interface("visualization_msgs/msg/Marker")()
    check(marker)
    marker.pose.position.z = math.nan
    with pytest.raises(InvalidInputError, match=r"pose\.position\.x, y, z"):
        check(marker)


def test_lists_of_messages_within_lists_are_checked() -> None:
    check = input_check("visualization_msgs/msg/MarkerArray")
    markers = get_interface("visualization_msgs/msg/MarkerArray")()
    marker = get_interface("visualization_msgs/msg/Marker")()
    marker.header.stamp.sec = -1  # the stamps of elements are not used
    marker.points = [Point(), Point(y=math.inf)]
    check(markers)
    markers.markers = [marker]
    with pytest.raises(InvalidInputError, match=r"markers\.points\.x, y, z = "):
        check(markers)


class Thinned(Listener):
    """Uses at most ten odometry messages a second."""

    INPUTS = (replace(Listener.INPUTS[0], most_hz=10.0),)


def test_a_fast_input_is_used_at_its_largest_rate_by_the_stamps() -> None:
    with GraphHarness() as graph:
        node = graph.add(Thinned(context=graph.context))
        for k in range(10):  # stamps 0.02 s apart, all at once as after a delay
            message = odometry(float(k))
            message.header.stamp.nanosec = 20_000_000 * k
            graph.publish("/odom", message)
        graph.run_for(0.4)
        used = [msg.pose.pose.position.x for msg in node.received]
        assert used == [0.0, 4.0, 9.0], "the last of each period"
        assert not node.is_stale("/odom")


def test_the_largest_rate_of_an_input_can_change_and_its_sources_learn_of_it() -> None:
    with GraphHarness() as graph:
        node = graph.add(Thinned(context=graph.context))
        source = graph.node.create_publisher(Odometry, "/odom", 10)
        stamps_ns = range(0, 200_000_000, 20_000_000)
        assert sum(map(source.is_used, stamps_ns)) == 3
        node.change_rate("/odom", 50.0)
        assert all(map(source.is_used, stamps_ns))
        for k in range(10):
            message = odometry(float(k))
            message.header.stamp.nanosec = 20_000_000 * k
            graph.publish("/odom", message)
        graph.run_for(0.4)
        assert len(node.received) == 10


def test_a_callback_may_take_the_info_of_its_messages() -> None:
    with GraphHarness() as graph:
        node = graph.add(Numbering(context=graph.context))
        for text in ("one", "bad", "three"):
            graph.publish("/text", String(data=text))
            graph.run_for(0.01)
        assert node.received == [("one", 1), ("three", 3)]
        assert node.dropped_inputs == {("/text", "bad_text"): 1}
