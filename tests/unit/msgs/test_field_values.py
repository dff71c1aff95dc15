"""Values that fields accept, convert and refuse."""

from array import array
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from navette.errors import MessageError
from navette.msgs import validate
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Point, Polygon, PoseWithCovariance, Vector3
from navette.msgs.nav_msgs.msg import OccupancyGrid, Path
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor, ParameterValue
from navette.msgs.sensor_msgs.msg import CompressedImage, JointState, LaserScan
from navette.msgs.shape_msgs.msg import SolidPrimitive
from navette.msgs.std_msgs.msg import (
    Bool,
    ByteMultiArray,
    Char,
    Float32,
    Float64,
    Int8,
    String,
    UInt64,
    UInt64MultiArray,
)


def test_floats_accept_numbers_of_any_kind() -> None:
    for value in (1, 1.0, np.float32(1), np.float64(1), np.int8(1)):
        message = Float64(data=value)
        assert message.data == 1.0
        assert type(message.data) is float
    assert np.isnan(Float64(data=float("nan")).data)
    assert np.isinf(Float32(data=-np.inf).data)


def test_integers_accept_numpy_scalars() -> None:
    message = Int8(data=np.int64(-128))
    assert type(message.data) is int
    assert message.data == -128
    assert UInt64(data=2**64 - 1).data == 2**64 - 1
    assert Char(data=255).data == 255
    assert type(Int8(data=True).data) is int  # as programs set Image.is_bigendian
    assert list(OccupancyGrid(data=[True, False]).data) == [1, 0]
    assert Bool(data=np.True_).data is True
    assert type(String(data=np.str_("a")).data) is str


def test_a_byte_is_bytes_as_in_rclpy_and_accepts_integers() -> None:
    assert DiagnosticStatus(level=2).level == DiagnosticStatus.ERROR == b"\x02"
    assert ByteMultiArray(data=[b"\x01", 255]).data == [b"\x01", b"\xff"]
    assert ByteMultiArray(data=b"\x01\xff").data == [b"\x01", b"\xff"]


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: Float64(data="1"), "Float64.data: '1' is str, expected a float"),
        (lambda: Float64(data=True), "is bool, expected a float"),
        (lambda: Float64(data=None), "None is NoneType"),
        (lambda: Float64(data=10**400), "out of range"),
        (lambda: Float32(data=1e39), r"1e\+39 is out of range, expected a float32"),
        (lambda: Int8(data=128), "128 is out of range, expected an integer from -128"),
        (lambda: Int8(data=1.0), "1.0 is float, expected an integer"),
        (lambda: UInt64(data=-1), "-1 is out of range"),
        (lambda: Bool(data=1), "1 is int, expected a bool"),
        (lambda: String(data=b"x"), "b'x' is bytes, expected a str"),
        (lambda: DiagnosticStatus(level=256), "expected one byte"),
        (lambda: DiagnosticStatus(level=b""), "expected one byte"),
        (lambda: DiagnosticStatus(level=True), "expected one byte"),
        (lambda: Path(header=Point()), "expected a std_msgs/msg/Header"),
        (
            lambda: Polygon(points=[Point()]),
            r"points\[0\]: .* a geometry_msgs/msg/Point32",
        ),
        (lambda: Polygon(points=3), "3 is int, expected a list"),
        (lambda: JointState(name="abc"), "'abc' is str, expected a list"),
        (lambda: JointState(name=["a", 1]), r"name\[1\]: 1 is int, expected a str"),
        (lambda: LaserScan(ranges="abc"), "'abc' is str, expected a sequence"),
        (lambda: LaserScan(ranges=1.0), "is float, expected a sequence"),
        (lambda: LaserScan(ranges=["1"]), "expected float32"),
        (lambda: LaserScan(ranges=[None]), "expected float32"),
        (lambda: LaserScan(ranges=[[1], [1, 2]]), "expected a sequence"),
        (
            lambda: LaserScan(ranges=np.zeros((2, 2))),
            r"shape \(2, 2\), expected one dim",
        ),
        (lambda: LaserScan(ranges=[1e39]), "do not fit float32"),
        (lambda: LaserScan(ranges={1.0: 2.0}), "is dict, expected a sequence"),
        (lambda: LaserScan(ranges=b"1234"), "is bytes, expected a sequence"),
        (lambda: OccupancyGrid(data=[128]), "128 to 128 do not fit int8"),
        (lambda: OccupancyGrid(data=[0.5]), "elements of float64"),
        (lambda: OccupancyGrid(data=np.zeros(2, bool)), "elements of bool"),
        (lambda: UInt64MultiArray(data=[-1]), "do not fit uint64"),
        (lambda: UInt64MultiArray(data=[2**64]), "expected a sequence of uint64"),
        (
            lambda: PoseWithCovariance(covariance=[0.0]),
            "1 elements, expected exactly 36",
        ),
        (
            lambda: ParameterValue(bool_array_value=[1]),
            r"value\[0\]: 1 is int",
        ),
    ],
)
def test_wrong_values_are_refused_by_name(make: Callable[[], Any], text: str) -> None:
    with pytest.raises(MessageError, match=text):
        make()
    # Error classes as in rclpy.
    assert issubclass(MessageError, TypeError)
    assert issubclass(MessageError, ValueError)


def test_assignment_checks_as_the_constructor_does() -> None:
    vector = Vector3()
    with pytest.raises(MessageError, match=r"geometry_msgs/msg/Vector3\.y: 'fast'"):
        vector.y = "fast"  # type: ignore[assignment]
    assert vector == Vector3()


@pytest.mark.parametrize(
    "value",
    [
        [1, 2, 3],
        (1, 2, 3),
        range(1, 4),
        np.array([1, 2, 3]),
        np.array([1.0, 2.0, 3.0]),
        np.array([1, 2, 3], ">i2"),
        np.arange(6)[1:4],
        np.array([1, 9, 2, 9, 3])[::2],
        array("f", [1, 2, 3]),
        memoryview(array("d", [1, 2, 3])),
        (number for number in (1, 2, 3)),
        {1: "a", 2: "b", 3: "c"}.keys(),
    ],
)
def test_arrays_accept_many_types(value: Any) -> None:
    assert LaserScan(ranges=value).ranges == array("f", [1.0, 2.0, 3.0])


def test_octets_from_bytes_are_writable() -> None:
    source = bytearray(b"\x00\xff")
    image = CompressedImage(data=source)
    source[0] = 9
    image.data[1] = 7
    assert image.data.tolist() == [0, 7]
    assert CompressedImage(data=array("B", [1, 2])).data.tobytes() == b"\x01\x02"


def test_integers_around_2_to_the_63() -> None:
    values = [0, 2**63, 2**64 - 1]
    assert UInt64MultiArray(data=values).data.tolist() == values
    assert UInt64MultiArray(data=[]).data.typecode == "Q"


def test_floats_in_arrays_may_be_nan_or_infinite() -> None:
    scan = LaserScan(ranges=[float("inf"), float("nan"), 1.0])
    assert np.isinf(scan.ranges[0])
    assert np.isnan(scan.ranges[1])


def test_a_message_does_not_share_an_array_with_the_caller() -> None:
    data, covariance = array("b", [0, 1]), np.zeros(36)
    grid = OccupancyGrid(data=data)
    assigned = PoseWithCovariance()
    assigned.covariance = covariance
    given = PoseWithCovariance(covariance=covariance)
    data[0], covariance[0] = 7, 7.0
    assert list(grid.data) == [0, 1]
    assert assigned.covariance[0] == given.covariance[0] == 0.0
    names, flags = ["a"], [True]
    assert JointState(name=names).name is names
    assert ParameterValue(bool_array_value=flags).bool_array_value is flags


def test_sequences_of_numbers_are_arrays_as_in_rclpy() -> None:
    grid = OccupancyGrid(data=np.array([1, 2], np.int8))
    grid.data.append(3)
    assert grid.data == array("b", [1, 2, 3])
    with pytest.raises(OverflowError):
        grid.data.append(128)
    view = np.asarray(grid.data)
    view[0] = 9  # no copy in between
    assert grid.data[0] == 9


def test_bools_are_a_list_as_in_rclpy() -> None:
    value = ParameterValue(bool_array_value=np.array([True, False]))
    assert value.bool_array_value == [True, False]
    assert type(value.bool_array_value[0]) is bool


def test_bounds_of_sequences() -> None:
    from navette.msgs.rcl_interfaces.msg import IntegerRange

    one = IntegerRange(from_value=0, to_value=5)
    assert ParameterDescriptor(integer_range=[one]).integer_range == [one]
    with pytest.raises(MessageError, match="2 elements, expected at most 1"):
        ParameterDescriptor(integer_range=[one, one])
    for wrong in ([0.0] * 4, array("d", [0.0] * 4), np.zeros(4)):
        with pytest.raises(MessageError, match="4 elements, expected at most 3"):
            SolidPrimitive(dimensions=wrong)


def test_validate_finds_invalid_list_elements() -> None:
    state = JointState(name=["a"])
    state.name.append(3)  # type: ignore[arg-type]
    with pytest.raises(MessageError, match=r"JointState\.name\[1\]: 3 is int"):
        validate(state)
