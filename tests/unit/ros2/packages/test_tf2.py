"""tf2_ros, tf2_py and tf2_geometry_msgs as programs for ROS 2 use them."""

import math
from typing import Any

import numpy as np
import pytest

from navette.msgs.geometry_msgs.msg import (
    Point32,
    Polygon,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Vector3,
    Vector3Stamped,
    Wrench,
    WrenchStamped,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.action import LookupTransform
from navette.msgs.tf2_msgs.srv import FrameGraph
from navette.ros2.packages import tf2_geometry_msgs, tf2_py, tf2_ros
from navette.ros2.packages.tf2_ros import Buffer, TransformListener
from navette.runtime import (
    ActionServer,
    Context,
    Duration,
    Future,
    GoalResponse,
    Node,
    Time,
)
from navette.runtime.testing import GraphHarness

HALF = math.sqrt(0.5)


def transform(
    parent: str, child: str, x: float, *, sec: int = 0, quarter_turn: bool = False
) -> TransformStamped:
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp.sec = sec
    message.transform.translation.x = x
    if quarter_turn:  # about z: x becomes y
        message.transform.rotation = Quaternion(z=HALF, w=HALF)
    return message


def test_the_hierarchy_of_exceptions() -> None:
    for name in (
        "LookupException",
        "ConnectivityException",
        "ExtrapolationException",
        "InvalidArgumentException",
        "TimeoutException",
    ):
        error = getattr(tf2_ros, name)
        assert issubclass(error, tf2_ros.TransformException)
        assert error is getattr(tf2_py, name)
    assert issubclass(tf2_ros.Buffer, tf2_ros.BufferInterface)
    assert issubclass(tf2_ros.Buffer, tf2_py.BufferCore)


def test_the_core_without_a_node() -> None:
    core = tf2_py.BufferCore(Duration(seconds=5))
    core.set_transform(transform("map", "odom", 1.0, sec=1), "somebody")
    core.set_transform_static(transform("odom", "base", 2.0), "somebody")
    found = core.lookup_transform_core("map", "base", Time())
    assert found.transform.translation.x == 3.0
    assert core.can_transform_core("map", "base", Time()) == (True, "")
    known, reason = core.can_transform_core("map", "bass", Time())
    assert not known
    assert "'bass' does not exist" in reason
    assert core._frameExists("map")
    assert core._getFrameStrings() == ["base", "map", "odom"]


def test_time_must_be_a_time() -> None:
    with pytest.raises(TypeError, match="Time"):
        Buffer().lookup_transform("map", "base", 1.5)


def test_can_transform_returns_the_reason() -> None:
    buffer = Buffer()
    buffer.set_transform(transform("map", "base", 1.0, sec=1), "x")
    ask = ("base", Time(seconds=1), "base", Time(seconds=9), "map")
    assert buffer.can_transform_full(*ask) is False
    answer = buffer.can_transform_full(*ask, return_debug_tuple=True)
    assert isinstance(answer, tuple)
    assert "future" in answer[1]
    late = buffer.can_transform("map", "base", Time(seconds=9), return_debug_tuple=True)
    assert late[0] is False


def test_a_buffer_without_node_uses_that_of_the_listener(graph: GraphHarness) -> None:
    node = graph.add(Node("frame_listener", context=graph.context))
    buffer = Buffer()
    listener = TransformListener(buffer, node, spin_thread=True)
    sender = tf2_ros.TransformBroadcaster(graph.node)
    found: list[float] = []

    def ask() -> None:
        timer.cancel()
        answer = buffer.lookup_transform(
            "map", "base", Time(seconds=2), Duration(seconds=5)
        )
        found.append(answer.transform.translation.x)

    timer = node.create_timer(0.5, ask)
    for sec in (1, 2):
        graph.node.create_timer(
            float(sec),
            lambda sec=sec: sender.sendTransform(
                (transform("map", "base", float(sec), sec=sec),)
            ),
        )
    graph.run_for(3.0)
    assert found == [2.0]
    listener.unregister()


def test_a_thread_spins_for_programs_that_do_not() -> None:
    context = Context()
    context.init()
    node = Node("spun", context=context)
    sender = tf2_ros.StaticTransformBroadcaster(node)
    buffer = tf2_ros.Buffer()
    listener = TransformListener(buffer, node, spin_thread=True)
    sender.sendTransform([transform("map", "base", 4.0)])
    found = buffer.lookup_transform("map", "base", Time(), Duration(seconds=20))
    assert found.transform.translation.x == 4.0
    listener.executor.stop()
    context.shutdown()
    listener.dedicated_listener_thread.join()


def test_a_listener_accepts_any_object(graph: GraphHarness) -> None:
    """A listener works with any object that has the two methods."""

    class Recorder:
        def __init__(self) -> None:
            self.seen: list[tuple[str, str, str]] = []

        def set_transform(self, message: Any, authority: str) -> None:
            self.seen.append(("moving", message.child_frame_id, authority))

        def set_transform_static(self, message: Any, authority: str) -> None:
            self.seen.append(("static", message.child_frame_id, authority))

    recorder = Recorder()
    listener = TransformListener(recorder, graph.node, qos=10, static_qos=None)
    tf2_ros.StaticTransformBroadcaster(graph.node).sendTransform(
        transform("a", "b", 0.0)
    )
    tf2_ros.TransformBroadcaster(graph.node, 5).sendTransform(transform("b", "c", 0.0))
    graph.run_for(0.0)
    assert recorder.seen == [
        ("static", "b", "default_authority"),
        ("moving", "c", "default_authority"),
    ]
    listener.unregister()


def test_a_future_has_the_transform_as_result(graph: GraphHarness) -> None:
    buffer = Buffer(node=graph.node)
    future = buffer.wait_for_transform_async("map", "base", Time())
    full = buffer.wait_for_transform_full_async(
        "base", Time(seconds=2), "base", Time(seconds=1), "map"
    )
    assert not future.done()
    buffer.set_transform(transform("map", "base", 1.0, sec=1), "x")
    assert future.result().transform.translation.x == 1.0
    assert not full.done()
    buffer.set_transform(transform("map", "base", 5.0, sec=2), "x")
    assert full.result().transform.translation.x == -4.0


def test_registration_of_types() -> None:
    class Sensed:
        def __init__(self, x: float) -> None:
            self.header = Header(frame_id="base")
            self.x = x

    buffer = Buffer()
    buffer.set_transform_static(transform("map", "base", 2.0), "x")
    with pytest.raises(tf2_ros.TypeException, match=r"Sensed.*known: .*PoseStamped"):
        buffer.transform(Sensed(1.0), "map")
    tf2_ros.TransformRegistration().add(
        Sensed, lambda sensed, t: Sensed(sensed.x + t.transform.translation.x)
    )
    assert buffer.transform(Sensed(1.0), "map").x == 3.0
    tf2_ros.ConvertRegistration().add_convert((Sensed, float), lambda sensed: sensed.x)
    assert buffer.transform(Sensed(1.0), "map", new_type=float) == 3.0
    with pytest.raises(tf2_ros.TypeException, match="convert to a message"):
        tf2_ros.convert(Sensed(1.0), PoseStamped)


def test_transform_through_a_fixed_frame() -> None:
    buffer = Buffer()
    for sec in (1, 2):
        buffer.set_transform(transform("map", "base", float(sec), sec=sec), "x")
    seen = tf2_ros.Stamped(PoseStamped(), Time(seconds=1), "base")
    moved = buffer.transform_full(seen, "base", Time(seconds=2), "map")
    assert moved.pose.position.x == -1.0
    assert moved.header.stamp.sec == 2


def test_interface_alone_has_no_transforms() -> None:
    class Half(tf2_ros.BufferInterface):
        pass

    with pytest.raises(tf2_ros.NotImplementedException):
        Half().lookup_transform("a", "b", Time())
    with pytest.raises(tf2_ros.NotImplementedException):
        Half().can_transform_full("a", Time(), "b", Time(), "c")


def test_the_covariance_is_rotated() -> None:
    pose = PoseWithCovarianceStamped()
    pose.pose.covariance = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).ravel()
    moved = tf2_geometry_msgs.do_transform_pose_with_covariance_stamped(
        pose, transform("map", "base", 2.0, quarter_turn=True)
    )
    assert moved.header.frame_id == "map"
    assert moved.pose.pose.position.x == 2.0
    wanted = np.diag([2.0, 1.0, 3.0, 5.0, 4.0, 6.0])
    assert np.allclose(moved.pose.covariance.reshape(6, 6), wanted)


def test_a_wrench_includes_the_torque_of_its_lever_arm() -> None:
    wrench = WrenchStamped(wrench=Wrench(force=Vector3(x=3.0), torque=Vector3(z=1.0)))
    moved = tf2_geometry_msgs.do_transform_wrench_stamped(
        wrench, transform("map", "base", 2.0, quarter_turn=True)
    )
    force, torque = moved.wrench.force, moved.wrench.torque
    assert (force.x, force.y, force.z) == pytest.approx((0, 3, 0))
    assert (torque.x, torque.y, torque.z) == pytest.approx((0, 0, 7))


def test_polygon_and_vector() -> None:
    turned = transform("map", "base", 1.0, quarter_turn=True)
    polygon = PolygonStamped(polygon=Polygon(points=[Point32(x=1.0), Point32(y=1.0)]))
    moved = tf2_geometry_msgs.do_transform_polygon_stamped(polygon, turned)
    corners = [(p.x, p.y) for p in moved.polygon.points]
    assert corners == [pytest.approx((1, 1)), pytest.approx((0, 0))]
    vector = Vector3Stamped(vector=Vector3(x=1.0))
    moved_vector = tf2_geometry_msgs.do_transform_vector3(vector, turned)
    assert moved_vector.vector.y == pytest.approx(1)
    assert turned.transform.translation.x == 1.0  # Jazzy's sets it to zero


def test_a_pose_with_its_parts() -> None:
    pose = tf2_geometry_msgs.do_transform_pose(
        Pose(), transform("map", "base", 1.0, quarter_turn=True)
    )
    assert (pose.orientation.z, pose.orientation.w) == pytest.approx((HALF, HALF))
    half_turn = transform("map", "base", 0.0)
    half_turn.transform.rotation = Quaternion(x=1.0, w=0.0)
    flipped = tf2_geometry_msgs.do_transform_pose(
        Pose(orientation=Quaternion(x=1.0, w=0.0)), half_turn
    )
    assert flipped.orientation.w == 1.0  # not −1, the same rotation
    assert tf2_geometry_msgs.from_msg_msg(pose) is pose
    with pytest.raises(tf2_ros.TypeException):
        Buffer().transform(Odometry(), "map")


def test_the_tree_is_served_as_yaml(graph: GraphHarness) -> None:
    node = graph.add(Node("listener", context=graph.context))
    buffer = Buffer(node=node)
    buffer.set_transform_static(transform("map", "odom", 1.0), "test")
    client = graph.node.create_client(FrameGraph, "/tf2_frames")
    answer = client.call(FrameGraph.Request(), timeout_sec=1.0)
    assert answer.frame_yaml == buffer.all_frames_as_yaml()
    assert "odom" in answer.frame_yaml


class Asking:
    """A buffer behind a server, and a client of it."""

    def __init__(self, graph: GraphHarness) -> None:
        self.graph = graph
        self.buffer = Buffer(node=graph.add(Node("keeper", context=graph.context)))
        keeper = graph.add(Node("server", context=graph.context))
        self.server = tf2_ros.BufferServer(self.buffer, keeper, "tf2_buffer_server")
        asker = graph.add(Node("asker", context=graph.context))
        self.client = tf2_ros.BufferClient(asker, "tf2_buffer_server")
        self.buffer.set_transform_static(transform("odom", "base", 2.0), "test")


def test_a_remote_buffer(graph: GraphHarness) -> None:
    asking = Asking(graph)
    client = asking.client
    assert client.wait_for_server(Duration(seconds=1))
    found = client.lookup_transform("odom", "base", Time())
    assert found.transform.translation.x == 2.0
    assert client.can_transform("odom", "base", Time().to_msg())
    full = client.lookup_transform_full("odom", Time(), "base", Time(), "odom")
    assert full.transform.translation.x == 2.0
    assert client.can_transform_full("odom", Time(), "base", Time(), "odom")
    assert not client.can_transform_full("odom", Time(), "nose", Time(), "odom")
    vector = Vector3Stamped(header=Header(frame_id="base"), vector=Vector3(x=1.0))
    assert client.transform(vector, "odom").vector.x == 1.0
    asking.client.destroy()


def test_errors_of_a_remote_buffer(graph: GraphHarness) -> None:
    asking = Asking(graph)
    with pytest.raises(tf2_ros.LookupException, match="nose"):
        asking.client.lookup_transform("odom", "nose", Time())
    asking.buffer.set_transform(transform("odom", "arm", 0.0, sec=5), "test")
    with pytest.raises(tf2_ros.ExtrapolationException):
        asking.client.lookup_transform("odom", "arm", Time(seconds=9))
    with pytest.raises(TypeError, match="expected a Time"):
        asking.client.lookup_transform("odom", "arm", 3)  # type: ignore[arg-type]
    asking.server.destroy()
    with pytest.raises(tf2_ros.TimeoutException, match="no buffer server for /tf2"):
        asking.client.lookup_transform("odom", "base", Time())
    assert not asking.client.can_transform("odom", "base", Time())


def test_a_request_waits_for_its_transform(graph: GraphHarness) -> None:
    asking = Asking(graph)
    late = transform("map", "odom", 1.0)
    graph.node.create_timer(0.5, lambda: asking.buffer.set_transform_static(late, "t"))
    found = asking.client.lookup_transform("map", "base", Time(), Duration(seconds=1))
    assert found.transform.translation.x == 3.0
    assert 0.5 <= graph.now_ns / 1e9 < 0.6


def test_a_server_that_does_not_respond(graph: GraphHarness) -> None:
    node = graph.add(Node("silent", context=graph.context))

    async def never(goal: Any) -> Any:
        await Future()

    ActionServer(node, LookupTransform, "tf2_buffer_server", never)
    asker = graph.add(Node("asker", context=graph.context))
    client = tf2_ros.BufferClient(asker, "tf2_buffer_server")
    with pytest.raises(tf2_ros.TimeoutException, match="did not respond in time"):
        client.lookup_transform("a", "b", Time(), Duration(seconds=1))
    assert graph.now_ns == 3_000_000_000


def test_a_server_that_rejects_the_request(graph: GraphHarness) -> None:
    node = graph.add(Node("proud", context=graph.context))
    ActionServer(
        node,
        LookupTransform,
        "tf2_buffer_server",
        lambda goal: None,
        goal_callback=lambda goal: GoalResponse.REJECT,
    )
    asker = graph.add(Node("asker", context=graph.context))
    client = tf2_ros.BufferClient(asker, "tf2_buffer_server")
    with pytest.raises(tf2_ros.TimeoutException, match="rejected the request"):
        client.lookup_transform("a", "b", Time())
