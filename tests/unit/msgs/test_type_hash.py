"""RIHS01 hashes compared with values computed by ROS 2."""

import pytest

from navette.msgs import register_definition, type_description, type_hash
from navette.msgs.parser import parse_action
from navette.msgs.registry import add_specs

# First 8 hex digits, from ROS 2 Jazzy.
GOLDEN = {
    "geometry_msgs/msg/Accel": "dc448243",
    "sensor_msgs/msg/CameraInfo": "b3dfd68f",
    "rosgraph_msgs/msg/Clock": "692f7a66",
    "std_msgs/msg/Float32": "7170d3d8",
    "std_msgs/msg/Header": "f49fb3ae",
    "sensor_msgs/msg/Image": "d31d41a9",
    "sensor_msgs/msg/Imu": "7d9a00ff",
    "sensor_msgs/msg/NavSatFix": "62223ab3",
    "nav_msgs/msg/Odometry": "3cc97dc7",
    "geometry_msgs/msg/Point32": "2fc4db7c",
    "sensor_msgs/msg/PointCloud2": "9198cabf",
    "sensor_msgs/msg/PointField": "5c6a4750",
    "geometry_msgs/msg/PoseWithCovariance": "9a7c0fd2",
    "sensor_msgs/msg/RegionOfInterest": "ad16bcba",
    "tf2_msgs/msg/TF2Error": "db2485e7",
    "tf2_msgs/msg/TFMessage": "e369d0f0",
    "builtin_interfaces/msg/Time": "b106235e",
    "geometry_msgs/msg/TransformStamped": "0a241f87",
    "geometry_msgs/msg/TwistWithCovariance": "49f574f0",
    "unique_identifier_msgs/msg/UUID": "1b8e8aca",
    "service_msgs/msg/ServiceEventInfo": "41bcbbe0",
    "example_interfaces/srv/AddTwoInts": "e118de6b",
}
# In full, as ``ros2 topic info -v`` and ``ros2 action info -v`` print them.
PRINTED = {
    "geometry_msgs/msg/Twist": (
        "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"
    ),
    "geometry_msgs/msg/TwistStamped": (
        "5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64"
    ),
    "action_msgs/srv/CancelGoal": (
        "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a"
    ),
    "action_msgs/msg/GoalStatusArray": (
        "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"
    ),
}
ROTATE_ABSOLUTE = {
    "_SendGoal": "3d5d3cfcbb721f88038eaedcd4af95565360a82b36f1983e3a6c7448d2d18fbe",
    "_GetResult": "f96fd02477be2a47122fca142e960d407b24850c6eac72047872ba764473c4ef",
    "_FeedbackMessage": (
        "bef10993e1ee82b35f99f7e390bac1e6cc64e2a3090536887832e122aa71f1b5"
    ),
}
FIBONACCI = {
    "_Goal": "834005bd",
    "_Result": "cf622af2",
    "_Feedback": "c1b73edc",
    "_SendGoal": "3d7412ff",
    "_GetResult": "8ebe9687",
    "_FeedbackMessage": "a941cc54",
}


@pytest.mark.parametrize(("name", "digits"), GOLDEN.items())
def test_messages_and_services(name: str, digits: str) -> None:
    assert type_hash(name).removeprefix("RIHS01_")[:8] == digits


@pytest.mark.parametrize(("part", "digits"), FIBONACCI.items())
def test_parts_of_an_action(part: str, digits: str) -> None:
    name = "rob599_msgs/action/Fibonacci"
    text = "int64 number\n---\nint64[] sequence\n---\nint64 progress\n"
    add_specs([parse_action(name, text)], ["rob599"])
    assert type_hash(name + part).removeprefix("RIHS01_")[:8] == digits


@pytest.mark.parametrize(("name", "digits"), PRINTED.items())
def test_whole_hashes(name: str, digits: str) -> None:
    assert type_hash(name) == f"RIHS01_{digits}"


@pytest.mark.parametrize(("part", "digits"), ROTATE_ABSOLUTE.items())
def test_whole_hashes_of_an_action(part: str, digits: str) -> None:
    name = "turtlesim_msgs/action/RotateAbsolute"
    text = "float32 theta\n---\nfloat32 delta\n---\nfloat32 remaining\n"
    add_specs([parse_action(name, text)], ["turtlesim"])
    assert type_hash(name + part) == f"RIHS01_{digits}"


def test_form_of_a_hash() -> None:
    prefix, _, digits = type_hash("std_msgs/String").partition("_")
    assert prefix == "RIHS01"
    assert len(digits) == 64


def test_type_ids_of_arrays_and_bounds() -> None:
    register_definition(
        "hash_cases/msg/All",
        "string a\nstring<=5 b\nwstring<=5[3] c\nchar[<=4] d\nbyte[] e\n"
        "std_msgs/Empty[2] f\n",
    )
    description = type_description("hash_cases/msg/All")
    types = [each["type"] for each in description["type_description"]["fields"]]
    assert [each["type_id"] for each in types] == [17, 21, 70, 99, 160, 49]
    assert [each["capacity"] for each in types] == [0, 0, 3, 4, 0, 2]
    assert [each["string_capacity"] for each in types] == [0, 5, 5, 0, 0, 0]
    assert types[-1]["nested_type_name"] == "std_msgs/msg/Empty"
    (empty,) = description["referenced_type_descriptions"]
    assert empty["fields"][0]["name"] == "structure_needs_at_least_one_member"
