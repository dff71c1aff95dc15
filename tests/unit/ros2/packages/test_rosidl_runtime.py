"""rosidl_runtime_py: messages as YAML, CSV, dicts and back; interfaces by name."""

import math
from collections import OrderedDict
from pathlib import Path
from typing import Any

import pytest
import yaml

from navette.errors import MessageError
from navette.msgs import register_definition
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.geometry_msgs.msg import (
    PointStamped,
    PoseWithCovariance,
    TransformStamped,
)
from navette.msgs.nav_msgs.msg import Path as PathMsg
from navette.msgs.sensor_msgs.msg import BatteryState, LaserScan
from navette.msgs.std_msgs.msg import Bool, Float64, String
from navette.msgs.std_srvs.srv import SetBool
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.ros2.packages import rosidl_runtime_py as rosidl
from navette.ros2.packages.rosidl_runtime_py import utilities
from navette.ros2.packages.rosidl_runtime_py.convert import yaml_pieces


def scan() -> LaserScan:
    message = LaserScan(angle_min=-1.5, range_max=20.0, ranges=[0.5, 1.0, 2.0])
    message.header.stamp.sec = 7
    message.header.frame_id = "lidar"
    return message


def test_yaml_in_the_form_of_ros2_topic_echo() -> None:
    text = rosidl.message_to_yaml(scan())
    assert text == (
        "header:\n"
        "  stamp:\n"
        "    sec: 7\n"
        "    nanosec: 0\n"
        "  frame_id: lidar\n"
        "angle_min: -1.5\n"
        "angle_max: 0.0\n"
        "angle_increment: 0.0\n"
        "time_increment: 0.0\n"
        "scan_time: 0.0\n"
        "range_min: 0.0\n"
        "range_max: 20.0\n"
        "ranges:\n"
        "- 0.5\n"
        "- 1.0\n"
        "- 2.0\n"
        "intensities: []\n"
    )
    assert rosidl.message_to_yaml(Bool(data=True), flow_style=True) == "{data: true}\n"


def test_texts_in_yaml() -> None:
    for text in ("", "plain", "ünï", "yes", "a: b", "line\nline", "x" * 500, "\0"):
        dumped = rosidl.message_to_yaml(String(data=text))
        assert yaml.safe_load(dumped) == {"data": text}
    assert rosidl.message_to_yaml(String(data="ünï")) == "data: ünï\n"
    assert rosidl.message_to_yaml(String(data="🤖")) == "data: 🤖\n"
    assert rosidl.message_to_yaml(DiagnosticStatus(level=1)).startswith(
        'level: "\\x01"\n'
    )


def test_arrays_in_yaml_equal_the_emitters_text() -> None:
    """Large arrays are written without the emitter, which is slow."""
    edges: list[list[Any]] = [
        [0, 1, 127, -128, -1] * 10,
        [2**63 - 1, -(2**63)] * 10,
        [0.0, -0.0, 1e17, 1.5e-7, 1e-05, math.inf, -math.inf, math.nan, 2.5] * 5,
        [True, False] * 20,
    ]
    for values, name in zip(edges, ("int8", "int64", "float64", "bool"), strict=True):
        cls = register_definition(f"text_{name}/msg/Array", f"{name}[] data\nstring s")
        for message in (cls(data=values, s="0xa 0xaaa\n0xa"), cls(data=values[:3])):
            plain = dict(rosidl.message_to_ordereddict(message))
            for flow in (False, True):
                text = rosidl.message_to_yaml(message, flow_style=flow)
                expected = yaml.safe_dump(
                    plain, sort_keys=False, default_flow_style=flow, width=10**6
                )
                assert text == expected
            pieces = list(yaml_pieces(message, None, width=30))
            assert max(map(len, pieces[1].split("\n"))) <= 30
            assert repr(yaml.safe_load("".join(pieces))) == repr(plain)


def test_shortened() -> None:
    dumped = rosidl.message_to_ordereddict(scan(), truncate_length=2)
    assert dumped["ranges"] == [0.5, 1.0, "..."]
    assert dumped["header"]["frame_id"] == "li..."
    hidden = rosidl.message_to_ordereddict(scan(), no_arr=True, no_str=True)
    assert hidden["ranges"] == "<sequence type: float, length: 3>"
    assert hidden["header"]["frame_id"] == "<string length: <5>>"
    covariance = rosidl.message_to_ordereddict(PoseWithCovariance(), no_arr=True)
    assert covariance["covariance"] == "<array type: double[36]>"
    poses = rosidl.message_to_ordereddict(PathMsg(), no_arr=True)
    assert poses["poses"] == (
        "<sequence type: geometry_msgs/msg/PoseStamped, length: 0>"
    )


def test_nested_ordered_dicts() -> None:
    array = DiagnosticArray(
        status=[DiagnosticStatus(name="n", values=[KeyValue(key="k", value="v")])]
    )
    dumped = rosidl.message_to_ordereddict(array)
    assert isinstance(dumped["status"][0], OrderedDict)
    assert dumped["status"][0]["values"] == [OrderedDict(key="k", value="v")]
    assert list(rosidl.get_message_slot_types(array)) == ["header", "status"]


def test_csv() -> None:
    assert rosidl.message_to_csv(PointStamped()) == "0,0,,0.0,0.0,0.0"
    text = rosidl.message_to_csv(scan(), truncate_length=2)
    assert text == "7,0,li...,-1.5,0.0,0.0,0.0,0.0,0.0,20.0,0.5,1.0,...,"
    hidden = rosidl.message_to_csv(scan(), no_arr=True, no_str=True)
    assert "<string length: <5>>" in hidden
    assert hidden.endswith("<sequence type: float, length: 0>")
    nested = TFMessage(transforms=[TransformStamped(child_frame_id="a")])
    assert rosidl.message_to_csv(nested) == "0,0,,a,0.0,0.0,0.0,0.0,0.0,0.0,1.0"


def test_fields_are_set_by_name() -> None:
    message = PathMsg()
    setters = rosidl.set_message_fields(
        message,
        {
            "header": {"frame_id": "map"},
            "poses": [{"pose": {"position": {"x": 1, "y": "2.5"}}}, {}],
        },
    )
    assert setters == []
    assert message.header.frame_id == "map"
    assert [p.pose.position.x for p in message.poses] == [1.0, 0.0]
    assert message.poses[0].pose.position.y == 2.5
    assert message.poses[0].pose.orientation.w == 1.0
    text = String()
    rosidl.set_message_fields(text, {"data": 5})
    assert text.data == "5"
    battery = BatteryState()
    rosidl.set_message_fields(battery, {"cell_voltage": [1, 2.5], "present": True})
    assert battery.cell_voltage.tolist() == [1.0, 2.5]


def test_stamps_that_are_set_later() -> None:
    message = PathMsg()
    setters = rosidl.set_message_fields(
        message,
        {"header": "auto", "poses": [{"header": {"stamp": "now"}}]},
        expand_header_auto=True,
        expand_time_now=True,
    )
    for set_stamp in setters:
        set_stamp(Time(sec=9))
    assert (message.header.stamp.sec, message.poses[0].header.stamp.sec) == (9, 9)
    with pytest.raises(MessageError, match=r"'auto'.*expected to be a dictionary"):
        rosidl.set_message_fields(message, {"header": "auto"})


@pytest.mark.parametrize(
    ("values", "error", "message"),
    [
        ({"point": {"w": 1}}, AttributeError, "Point has no field 'w'.*x, y, z"),
        ({"point": {"x": "one"}}, TypeError, "x"),
        ({"point": [1, 2, 3]}, TypeError, "expected to be a dictionary but is a list"),
        ("text", TypeError, "is expected to be a dictionary"),
    ],
)
def test_wrong_values(values: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message) as caught:
        rosidl.set_message_fields(PointStamped(), values)
    assert isinstance(caught.value, MessageError)


def test_a_text_is_not_a_bool() -> None:
    with pytest.raises(MessageError):  # bool("false") would be True
        rosidl.set_message_fields(Bool(), {"data": "false"})
    number = Float64()
    rosidl.set_message_fields(number, {"data": ".5"})
    assert number.data == 0.5


def test_classes_by_name() -> None:
    assert utilities.get_message("std_msgs/msg/String") is String
    assert utilities.get_message("std_msgs/String") is String
    assert utilities.get_service("std_srvs/SetBool") is SetBool
    assert utilities.get_action("example_interfaces/action/Fibonacci") is Fibonacci
    assert utilities.get_interface("std_srvs/srv/SetBool") is SetBool
    with pytest.raises(ValueError, match="full name of a message"):
        utilities.get_message("std_srvs/srv/SetBool")
    with pytest.raises(AttributeError, match=r"known: .*std_msgs/msg/String"):
        utilities.get_message("std_msgs/msg/Strin")
    with pytest.raises(ValueError, match="expected"):
        utilities.get_interface("String")


def test_classes_by_field_type() -> None:
    types = rosidl.get_message_slot_types(scan())
    header = rosidl.import_message_from_namespaced_type(types["header"])
    assert header.__name__ == "Header"
    feedback = rosidl.import_message_from_namespaced_type(
        "example_interfaces/action/Fibonacci_FeedbackMessage"
    )
    assert feedback is Fibonacci.Impl.FeedbackMessage


def test_lists_and_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert rosidl.get_interfaces(["std_srvs"]) == {
        "std_srvs": ["srv/Empty", "srv/SetBool", "srv/Trigger"]
    }
    assert "msg/String" in rosidl.get_message_interfaces()["std_msgs"]
    assert rosidl.get_service_interfaces(["std_msgs"]) == {}
    actions = rosidl.get_action_interfaces(["example_interfaces"])
    assert actions == {"example_interfaces": ["action/Fibonacci"]}
    assert "std_msgs" in rosidl.get_interface_packages()
    path = Path(rosidl.get_interface_path("std_msgs/msg/String"))
    assert path.read_text().startswith("string data")
    assert rosidl.get_interface_path("std_msgs/msg/String.msg") == str(path)
    with pytest.raises(LookupError, match="interface of std_msgs"):
        rosidl.get_interface_path("std_msgs/msg/Nothing")
    with pytest.raises(LookupError, match="'nowhere' not found"):
        rosidl.get_interfaces(["nowhere"])
    with pytest.raises(ValueError, match="expected 'package/msg/Name'"):
        rosidl.get_interface_path("../etc")
