"""Transforms over time: chains, interpolation, limits, errors, broadcasting."""

import math
from collections.abc import Callable
from typing import Any

import pytest
import yaml

from navette.errors import InvalidValueError, TransformError
from navette.geometry import Pose2, Transform3, yaw_of
from navette.msgs.geometry_msgs.msg import (
    Point,
    PointStamped,
    PoseStamped,
    TransformStamped,
    Vector3,
    Vector3Stamped,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_msgs.msg import Header
from navette.runtime import (
    Buffer,
    Duration,
    Node,
    StaticTransformBroadcaster,
    Time,
    TransformBroadcaster,
    TransformListener,
)
from navette.runtime.testing import GraphHarness
from navette.runtime.tf import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
)
from navette.runtime.tf.buffer_core import BufferCore
from navette.runtime.tf.conversions import transform_stamped

S = 1_000_000_000


def at(x: float, y: float = 0.0, yaw: float = 0.0) -> Transform3:
    return Transform3.from_pose2(Pose2(x, y, yaw))


@pytest.fixture
def core() -> BufferCore:
    """map → odom → base (moving), base → lidar (static), other → far."""
    core = BufferCore(10 * S)
    for second in range(1, 5):
        core.set("map", "odom", second * S, at(0, second), is_static=False)
        core.set("odom", "base", second * S, at(second), is_static=False)
    core.set("base", "lidar", 0, at(0.5, 0, math.pi / 2), is_static=True)
    core.set("other", "far", S, at(1), is_static=False)
    return core


def test_chain_in_both_directions(core: BufferCore) -> None:
    map_T_lidar, stamp = core.lookup("map", "lidar", 2 * S)
    assert stamp == 2 * S
    assert map_T_lidar.to_pose2() == pytest.approx((2.5, 2, math.pi / 2))
    lidar_T_map, _ = core.lookup("lidar", "map", 2 * S)
    back = (map_T_lidar @ lidar_T_map).to_pose2()
    assert back == pytest.approx((0, 0, 0), abs=1e-12)


def test_siblings_meet_below_the_root(core: BufferCore) -> None:
    core.set("base", "camera", 0, at(0, 1), is_static=True)
    camera_T_lidar, _ = core.lookup("camera", "lidar", 3 * S)
    assert camera_T_lidar.to_pose2() == pytest.approx((0.5, -1, math.pi / 2))


def test_interpolated_between_samples(core: BufferCore) -> None:
    pose = core.lookup("map", "base", 5 * S // 2)[0].to_pose2()
    assert pose == pytest.approx((2.5, 2.5, 0))


def test_the_newest_transform_follows_every_change(core: BufferCore) -> None:
    assert core.lookup("map", "base", 0)[0].to_pose2().x == pytest.approx(4)
    core.set("odom", "base", 4 * S, at(7), is_static=False)
    assert core.lookup("map", "base", 0)[0].to_pose2().x == pytest.approx(7)
    core.set("base", "lidar", 0, at(1), is_static=True)
    assert core.lookup("map", "lidar", 0)[0].to_pose2().x == pytest.approx(8)
    core.drop_moving()
    with pytest.raises(ConnectivityException):
        core.lookup("map", "base", 0)


def test_time_zero_is_the_newest_common_time(core: BufferCore) -> None:
    core.set("odom", "base", 9 * S // 2, at(7), is_static=False)
    pose, stamp = core.lookup("map", "lidar", 0)
    assert stamp == 4 * S
    assert pose.translation[0] == pytest.approx(4.5)
    assert core.lookup("odom", "lidar", 0)[1] == 9 * S // 2
    assert core.newest_common_ns("map", "base") == 4 * S
    assert core.newest_common_ns("base", "lidar") == 0


def test_a_frame_in_itself(core: BufferCore) -> None:
    assert core.lookup("base", "base", 123) == (Transform3.identity(), 123)


@pytest.mark.parametrize("stamp", [S - 1, 4 * S + 1])
def test_outside_the_buffered_time(core: BufferCore, stamp: int) -> None:
    with pytest.raises(ExtrapolationException, match=r"1\.000000 … 4\.000000 s"):
        core.lookup("map", "base", stamp)


def test_unknown_and_unconnected_frames(core: BufferCore) -> None:
    with pytest.raises(LookupException, match=r"'mapp'.*known: base, far"):
        core.lookup("mapp", "base", 0)
    with pytest.raises(LookupException):
        core.lookup("mapp", "mapp", 0)
    with pytest.raises(ConnectivityException, match=r"roots 'map' and 'other'"):
        core.lookup("map", "far", 0)
    assert issubclass(ConnectivityException, TransformError)


def test_old_samples_are_dropped(core: BufferCore) -> None:
    core.set("odom", "base", 12 * S, at(9), is_static=False)
    core.set("map", "odom", 12 * S, at(9), is_static=False)
    with pytest.raises(ExtrapolationException, match="past"):
        core.lookup("map", "base", S)
    core.lookup("map", "base", 2 * S)
    # Too old to be taken over at all.
    core.set("odom", "base", S, at(100), is_static=False)
    with pytest.raises(ExtrapolationException):
        core.lookup("odom", "base", S)


def test_many_samples_stay_bounded() -> None:
    core = BufferCore(S)
    for step in range(1000):
        core.set("a", "b", step * S // 100, at(step), is_static=False)
    assert core.histories()["b"].oldest_ns == 999 * S // 100 - S
    pose = core.lookup("a", "b", 995 * S // 100)[0]
    assert pose.translation[0] == pytest.approx(995)
    assert len(core.histories()["b"]._stamps) < 200


def test_samples_out_of_order_and_repeated(core: BufferCore) -> None:
    core.set("odom", "base", 5 * S // 2, at(100), is_static=False)
    core.set("odom", "base", 3 * S, at(50), is_static=False)
    assert core.lookup("odom", "base", 5 * S // 2)[0].translation[0] == 100
    assert core.lookup("odom", "base", 3 * S)[0].translation[0] == 50
    assert core.lookup("odom", "base", 11 * S // 4)[0].translation[0] == 75


def test_a_frame_that_changes_its_parent(core: BufferCore) -> None:
    core.set("map", "dock", 0, at(10), is_static=True)
    core.lookup("map", "base", 0)
    core.set("dock", "base", 5 * S, at(1), is_static=False)
    assert core.lookup("map", "base", 5 * S)[0].translation[0] == 11
    # At the old time it still hangs where it did.
    assert core.lookup("map", "base", 3 * S)[0].to_pose2() == pytest.approx((3, 3, 0))
    with pytest.raises(ExtrapolationException, match="'odom' in 'map'"):
        core.lookup("map", "base", 4 * S + 1)


def test_frames_above_the_common_ancestor_may_be_missing(core: BufferCore) -> None:
    core.set("odom", "base", 6 * S, at(6), is_static=False)
    assert core.lookup("odom", "lidar", 6 * S)[0].translation[0] == 6.5
    with pytest.raises(ExtrapolationException, match="'odom' in 'map'"):
        core.lookup("map", "lidar", 6 * S)


@pytest.mark.parametrize(
    ("parent", "child", "transform"),
    [
        ("", "b", at(0)),
        ("a", "", at(0)),
        ("a", "/a", at(0)),
        ("a", "b", at(math.nan)),
        ("a", "b", at(math.inf)),
        ("a", "b", Transform3((0, 0, 0), (0, 0, 0, 0))),
        ("a", "b", Transform3((0, 0, 0), (0, 0, 1, 1))),
    ],
)
def test_malformed_transforms(parent: str, child: str, transform: Transform3) -> None:
    with pytest.raises(InvalidArgumentException):
        BufferCore(S).set(parent, child, 0, transform, is_static=True)


def test_an_invalid_transform_changes_nothing(core: BufferCore) -> None:
    known = core.lookup("map", "base", 2 * S)
    zero = Transform3((1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))
    for child, is_static in (("new", False), ("base", False), ("base", True)):
        with pytest.raises(InvalidArgumentException, match="norm"):
            core.set("map", child, 3 * S, zero, is_static=is_static)
    assert core.lookup("map", "base", 2 * S) == known
    with pytest.raises(LookupException, match="'new' does not exist"):
        core.lookup("map", "new", 0)


def test_a_cycle_of_frames_is_an_error() -> None:
    core = BufferCore(S)
    core.set("a", "b", 0, at(1), is_static=True)
    core.set("b", "a", 0, at(1), is_static=True)
    core.set("c", "d", 0, at(1), is_static=True)
    with pytest.raises(InvalidArgumentException, match="form a cycle"):
        core.lookup("a", "d", 0)


def test_a_leading_slash_is_ignored(core: BufferCore) -> None:
    assert core.lookup("/map", "/base", 2 * S) == core.lookup("map", "base", 2 * S)


@pytest.mark.parametrize(
    "time_of",
    [
        lambda ns: Time(nanoseconds=ns),
        lambda ns: Time(nanoseconds=ns).to_msg(),
        lambda ns: ns,
    ],
)
def test_types_of_times(time_of: Callable[[int], Any]) -> None:
    buffer = Buffer()
    for second in (1, 2):
        buffer.set_transform(transform_stamped("map", "base", second * S, at(second)))
    found = buffer.lookup_transform("map", "base", time_of(3 * S // 2))
    assert isinstance(found, TransformStamped)
    assert (found.header.frame_id, found.child_frame_id) == ("map", "base")
    assert found.header.stamp == Time(nanoseconds=3 * S // 2).to_msg()
    assert found.transform.translation.x == 1.5
    assert buffer.can_transform("map", "base", time_of(S))
    assert not buffer.can_transform("map", "base", time_of(3 * S))


def test_full_lookup_through_a_fixed_frame() -> None:
    buffer = Buffer()
    for second in (1, 2):
        buffer.set_transform(transform_stamped("map", "base", second * S, at(second)))
    # Where the base of one second ago is, seen from the base of now.
    found = buffer.lookup_transform_full("base", 2 * S, "base", 1 * S, "map")
    assert found.transform.translation.x == -1.0
    assert buffer.get_latest_common_time("map", "base").nanoseconds == 2 * S


def test_yaml_and_clear() -> None:
    buffer = Buffer()
    assert yaml.safe_load(buffer.all_frames_as_yaml()) == []
    buffer.set_transform_static(transform_stamped("base", "lidar", 0, at(1)))
    for second in (1, 2, 3):
        message = transform_stamped("map", "base", second * S, at(second))
        buffer.set_transform(message, "the robot")
    frames = yaml.safe_load(buffer.all_frames_as_yaml())
    assert frames["lidar"]["parent"] == "base"
    assert frames["lidar"]["broadcaster"] == "no recorded authority"
    assert frames["base"] == {
        "parent": "map",
        "broadcaster": "the robot",
        "rate": 1.5,
        "most_recent_transform": 3.0,
        "oldest_transform": 1.0,
        "buffer_length": 2.0,
    }
    assert "Frame base exists with parent map.\n" in buffer.all_frames_as_string()
    buffer.clear()
    assert not buffer.can_transform("map", "base", 0)
    assert buffer.can_transform("base", "lidar", 0)  # static: true at all times


def test_broadcaster_and_listener(graph: GraphHarness) -> None:
    static = StaticTransformBroadcaster(graph.node)
    static.sendTransform(transform_stamped("base", "lidar", 0, at(1)))
    static.send_transform([transform_stamped("base", "camera", 0, at(2))])
    moving = TransformBroadcaster(graph.node)
    graph.run_for(1.0)
    node = graph.add(Node("late", context=graph.context))
    buffer = Buffer(node=node)
    listener = TransformListener(buffer, node)
    moving.sendTransform(transform_stamped("map", "base", S, at(3)))
    graph.run_for(0.0)
    assert buffer.lookup("map", "lidar", 0).translation[0] == 4
    assert buffer.lookup("map", "camera", 0).translation[0] == 5
    listener.unregister()
    moving.sendTransform(transform_stamped("map", "base", 2 * S, at(9)))
    graph.run_for(0.0)
    assert buffer.lookup("map", "base", 0).translation[0] == 3


def test_lookup_waits_inside_a_callback(graph: GraphHarness) -> None:
    node = graph.add(Node("waits", context=graph.context))
    buffer = Buffer(node=node)
    TransformListener(buffer, node)
    moving = TransformBroadcaster(graph.node)
    found: list[float] = []

    def ask() -> None:
        timer.cancel()
        transform = buffer.lookup_transform(
            "map", "base", 2 * S, timeout=Duration(seconds=5)
        )
        found.append(transform.transform.translation.x)
        found.append(graph.now_ns / S)

    timer = node.create_timer(0.5, ask)
    graph.node.create_timer(
        1.0,
        lambda: moving.sendTransform(
            transform_stamped("map", "base", graph.now_ns, at(graph.now_ns / S))
        ),
    )
    graph.run_for(4.0)
    assert found == [2.0, 2.0]


def test_a_timeout_raises_the_lookup_error(graph: GraphHarness) -> None:
    buffer = Buffer(node=graph.node)
    with pytest.raises(LookupException):
        buffer.lookup_transform("map", "base", 0, timeout=Duration(seconds=1))
    assert graph.now_ns == S


def test_awaiting_a_transform(graph: GraphHarness) -> None:
    buffer = Buffer(node=graph.node)
    found: list[float] = []

    async def ask() -> None:
        timer.cancel()
        transform = await buffer.lookup_transform_async("map", "base", 0)
        found.append(transform.transform.translation.x)

    timer = graph.node.create_timer(0.5, ask)
    graph.run_for(1.0)
    assert found == []
    buffer.set_transform(transform_stamped("other", "x", S, at(1)))
    buffer.set_transform(transform_stamped("map", "base", S, at(7)))
    graph.run_for(0.0)
    assert found == [7.0]


def test_an_invalid_transform_is_logged_and_the_others_are_used(
    graph: GraphHarness,
) -> None:
    logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    node = graph.add(Node("n", context=graph.context))
    buffer = Buffer(node=node)
    TransformListener(buffer, node)
    TransformBroadcaster(graph.node).sendTransform(
        [
            transform_stamped("map", "bad", S, at(math.nan)),
            transform_stamped("map", "good", S, at(1)),
        ]
    )
    graph.run_for(0.0)
    assert buffer.can_transform("map", "good", 0)
    assert "'bad' is not finite" in logs.last.msg


def test_stamped_messages_in_another_frame() -> None:
    buffer = Buffer()
    buffer.set_transform_static(
        transform_stamped("map", "base", 0, at(1, 2, math.pi / 2))
    )
    header = Header(frame_id="base")
    point = buffer.transform(
        PointStamped(header=header, point=Point(x=1.0, y=0.0, z=0.5)), "map"
    )
    assert point.header.frame_id == "map"
    assert (point.point.x, point.point.y, point.point.z) == pytest.approx((1, 3, 0.5))
    vector = buffer.transform(
        Vector3Stamped(header=header, vector=Vector3(x=1.0)), "map"
    )
    assert (vector.vector.x, vector.vector.y) == pytest.approx((0, 1))
    pose = buffer.transform(PoseStamped(header=header), "map")
    q = pose.pose.orientation
    assert (pose.pose.position.x, pose.pose.position.y) == pytest.approx((1, 2))
    assert yaw_of((q.x, q.y, q.z, q.w)) == pytest.approx(math.pi / 2)
    with pytest.raises(InvalidValueError, match="cannot transform a Odometry"):
        buffer.transform(Odometry(header=header), "map")
