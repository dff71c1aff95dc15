"""Generated classes: constructors, constants, equality, repr, pickling."""

import copy
import pickle
from array import array

import numpy as np
import pytest

from navette.errors import InvalidNameError, MessageError, UnknownNameError
from navette.msgs import (
    copy_message,
    deserialize,
    fields,
    get_interface,
    register_definition,
    serialize,
    type_name,
)
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.sensor_msgs.msg import CameraInfo, LaserScan, NavSatStatus
from navette.msgs.slot_types import BasicType, NamespacedType, UnboundedSequence
from navette.msgs.std_msgs.msg import ByteMultiArray, Empty, Header, String


def test_fields_start_at_their_ros_defaults() -> None:
    pose = Pose()
    assert (pose.orientation.w, pose.orientation.x) == (1.0, 0.0)
    assert NavSatStatus().status == NavSatStatus.STATUS_UNKNOWN == -2
    assert CameraInfo().k.dtype == np.float64
    assert CameraInfo().k.tolist() == [0.0] * 9
    assert DiagnosticStatus().level == DiagnosticStatus.OK == b"\0"


def test_messages_share_nothing_by_default() -> None:
    first, second = Odometry(), Odometry()
    first.pose.covariance[0] = 1.0
    first.twist.twist.linear.x = 1.0
    assert second == Odometry()
    OccupancyGrid().data.append(1)
    assert not OccupancyGrid().data


def test_keywords_set_fields() -> None:
    scan = LaserScan(header=Header(frame_id="lidar"), ranges=[1, 2.5])
    assert scan.header.frame_id == "lidar"
    assert scan.ranges == array("f", [1.0, 2.5])


def test_unknown_keyword_lists_the_fields() -> None:
    with pytest.raises(MessageError, match=r"no field 'lin'.*linear, angular"):
        Twist(lin=1)  # type: ignore[call-arg]


def test_unknown_attribute_is_refused() -> None:
    with pytest.raises(AttributeError):
        Twist().lienar = Vector3()  # type: ignore[attr-defined]


def test_nested_fields_can_be_assigned_in_place() -> None:
    twist = Twist()
    twist.linear.x = 1
    assert isinstance(twist.linear.x, float)
    assert twist == Twist(linear=Vector3(x=1.0))


def test_equality_compares_values_of_one_type() -> None:
    assert Point(x=1.0) == Point(x=1.0) != Point(x=2.0)
    assert Point() != Vector3()
    grid = OccupancyGrid(data=[1, 2])
    assert grid == OccupancyGrid(data=[1, 2])
    assert grid != OccupancyGrid(data=[1, 2, 3])
    assert grid != OccupancyGrid(data=[1, 3])
    assert Point(x=float("nan")) != Point(x=float("nan"))


def test_messages_are_not_hashable() -> None:
    with pytest.raises(TypeError):
        hash(Point())


def test_repr_is_that_of_rclpy() -> None:
    assert repr(Time(sec=1)) == "builtin_interfaces.msg.Time(sec=1, nanosec=0)"
    text = repr(LaserScan(ranges=[1, 0.1]))
    assert text.endswith("ranges=[1.0, 0.10000000149011612], intensities=[])")
    assert "k=array([0., 0., 0., 0., 0., 0., 0., 0., 0.])" in repr(CameraInfo())
    octets = ByteMultiArray(data=[b"a"])
    assert repr(octets).endswith("data_offset=0), data=[b'a'])")


def test_pickle_and_copy() -> None:
    message = LaserScan(header=Header(frame_id="x"), ranges=[1.0])
    assert pickle.loads(pickle.dumps(message)) == message
    deep = copy.deepcopy(message)
    deep.header.frame_id = "y"
    deep.ranges[0] = 2.0
    assert (message.header.frame_id, message.ranges[0]) == ("x", 1.0)
    assert copy.copy(message).header is message.header


def test_types_of_fields_are_spelt_as_in_rclpy() -> None:
    assert Header.get_fields_and_field_types() == {
        "stamp": "builtin_interfaces/Time",
        "frame_id": "string",
    }
    types = Odometry().twist.get_fields_and_field_types()
    assert types["covariance"] == "double[36]"
    assert LaserScan.get_fields_and_field_types()["ranges"] == "sequence<float>"
    assert DiagnosticStatus.get_fields_and_field_types()["level"] == "octet"
    floats = UnboundedSequence(BasicType("float"))
    assert LaserScan.SLOT_TYPES[-2:] == (floats, floats)
    assert LaserScan.SLOT_TYPES[0] == NamespacedType(("std_msgs", "msg"), "Header")
    assert [each.name for each in fields(Quaternion)] == ["x", "y", "z", "w"]


def test_slots_are_named_as_in_rclpy() -> None:
    assert Header.__slots__ == ("_stamp", "_frame_id")


def test_a_message_without_fields() -> None:
    assert Empty() == Empty()
    assert repr(Empty()) == "std_msgs.msg.Empty()"
    assert fields(Empty) == ()


def test_fields_named_like_python_keywords() -> None:
    register_definition("class_cases/msg/Move", "int32 from 3\nint32 to\n")
    move = get_interface("class_cases/msg/Move")
    message = move(**{"from": 1, "to": 2})
    assert getattr(message, "from") == 1
    assert getattr(move(to=2), "from") == 3
    assert deserialize(serialize(message), move) == message == copy_message(message)


def test_the_same_name_gives_the_same_class() -> None:
    assert get_interface("std_msgs/msg/String") is String
    assert get_interface("std_msgs/String") is String
    assert type_name(String) == type_name(String()) == "std_msgs/msg/String"
    assert type_name(AddTwoInts) == "example_interfaces/srv/AddTwoInts"


def test_service_classes() -> None:
    request = AddTwoInts.Request(a=1, b=2)
    assert type_name(request) == "example_interfaces/srv/AddTwoInts_Request"
    event = AddTwoInts.Event(request=[request])
    assert event.request[0].b == 2
    with pytest.raises(MessageError, match="at most 1"):
        AddTwoInts.Event(request=[request, request])
    with pytest.raises(NotImplementedError, match="Request, Response, Event"):
        AddTwoInts()


def test_action_classes() -> None:
    goal = Fibonacci.Goal(order=5)
    send = Fibonacci.Impl.SendGoalService.Request(goal=goal)
    assert send.goal.order == 5
    assert len(send.goal_id.uuid) == 16
    assert type_name(Fibonacci.Impl.SendGoalService) == (
        "example_interfaces/action/Fibonacci_SendGoal"
    )
    assert type_name(Fibonacci.Impl.FeedbackMessage) == (
        "example_interfaces/action/Fibonacci_FeedbackMessage"
    )
    assert type_name(Fibonacci.Impl.CancelGoalService) == "action_msgs/srv/CancelGoal"
    assert type_name(Fibonacci.Impl.GoalStatusMessage) == (
        "action_msgs/msg/GoalStatusArray"
    )


@pytest.mark.parametrize(
    "name", ["Twist", "a/b/C/d", "geometry_msgs/foo/Twist", "a/msg/B c", ""]
)
def test_malformed_names(name: str) -> None:
    with pytest.raises(InvalidNameError, match="expected 'package/msg/Name'"):
        get_interface(name)


def test_errors_of_unknown_names_list_the_known_ones() -> None:
    with pytest.raises(UnknownNameError, match="geometry_msgs/msg/Twist"):
        get_interface("geometry_msgs/msg/Twits")
    with pytest.raises(UnknownNameError, match="std_srvs"):
        get_interface("geometry_msg/msg/Twist")
    with pytest.raises(UnknownNameError, match="neither"):
        type_name(3)
    with pytest.raises(MessageError, match="neither"):
        fields(AddTwoInts)  # type: ignore[arg-type]


def test_modules_list_their_classes() -> None:
    import navette.msgs.std_msgs.msg as module

    assert "String" in dir(module)
    with pytest.raises(AttributeError, match="no 'Strung'; it has"):
        module.Strung  # type: ignore[attr-defined]  # noqa: B018 - raises


@pytest.mark.parametrize("use", ["keyword", "default", "setter", "read", "subclass"])
def test_the_first_use_of_a_class_is_as_any_other(use: str) -> None:
    point = register_definition(f"made_for/{use.title()}", "float64 self 2.5\nint8 n")
    holder = register_definition(
        f"made_for/{use.title()}Holder", f"made_for/{use.title()} point"
    )
    match use:
        case "keyword":
            made = point(self=3.0, n=4)
        case "default":
            made = holder().point
        case "setter":
            made = object.__new__(point)
            made.self, made.n = 2.5, 0
        case "read":
            made = deserialize(serialize(holder(point=point())), holder).point
        case _:
            made = type("Mine", (point,), {})()
    assert made == (type(made)(self=3.0, n=4) if use == "keyword" else type(made)())
    assert made.self == (3.0 if use == "keyword" else 2.5)
    with pytest.raises(MessageError, match=r"n .*int8"):
        made.n = 200
    with pytest.raises(MessageError, match="no field 'm'; its fields: self, n"):
        point(m=1)
    with pytest.raises(TypeError):
        point(1.0)
