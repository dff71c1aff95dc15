"""CDR of known bytes, and errors of malformed bytes."""

import struct
from typing import Any

import pytest

from navette.errors import DecodeError, MessageError
from navette.msgs import deserialize, get_interface, register_definition, serialize
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.example_interfaces.msg import WString
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.geometry_msgs.msg import Point, Polygon, Twist
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor, ParameterValue
from navette.msgs.sensor_msgs.msg import JointState, LaserScan
from navette.msgs.std_msgs.msg import (
    Bool,
    Empty,
    Float64,
    Float64MultiArray,
    String,
    UInt8MultiArray,
)
from navette.msgs.visualization_msgs.msg import Marker

LITTLE = b"\x00\x01\x00\x00"
BIG = b"\x00\x00\x00\x00"


def test_known_bytes() -> None:
    assert serialize(Time(sec=1, nanosec=2)) == LITTLE + struct.pack("<iI", 1, 2)
    assert serialize(String(data="hi")) == LITTLE + b"\x03\0\0\0hi\0"
    assert serialize(String()) == LITTLE + b"\x01\0\0\0\0"
    assert serialize(Bool(data=True)) == LITTLE + b"\x01"
    assert serialize(Empty()) == LITTLE + b"\x00"
    assert serialize(WString(data="a€")) == LITTLE + struct.pack("<3I", 2, 97, 0x20AC)


def test_alignment_starts_after_the_header() -> None:
    message = ParameterValue(type=3, double_value=1.0)
    # uint8, bool, 6 bytes of padding, int64, double: the double starts at 4 + 16.
    assert serialize(message)[20:28] == struct.pack("<d", 1.0)


def test_an_empty_sequence_of_doubles_has_no_padding() -> None:
    register_definition("cdr_cases/msg/Doubles", "float64[] a\nuint8 b\n")
    doubles = get_interface("cdr_cases/msg/Doubles")
    assert serialize(doubles(b=7)) == LITTLE + b"\0\0\0\0\x07"
    filled = LITTLE + struct.pack("<I4xdB", 1, 0.5, 7)
    assert serialize(doubles(a=[0.5], b=7)) == filled
    assert deserialize(filled, doubles) == doubles(a=[0.5], b=7)


def test_elements_of_a_list_are_not_aligned_as_structures() -> None:
    register_definition(
        "cdr_cases/msg/Points",
        "cdr_cases/P[] p\n" + "=" * 80 + "\nMSG: cdr_cases/P\nuint8 a\nfloat64 b\n",
    )
    points = get_interface("cdr_cases/msg/Points")
    point = get_interface("cdr_cases/msg/P")
    message = points(p=[point(a=1, b=1.5), point(a=2, b=2.5)])
    data = LITTLE + struct.pack("<IB3xdB7xd", 2, 1, 1.5, 2, 2.5)
    assert serialize(message) == data
    assert deserialize(data, points) == message


def test_a_message_that_starts_with_a_list() -> None:
    register_definition(
        "cdr_cases/msg/Pair", "geometry_msgs/Point[2] p\nstring[2] names\n"
    )
    pair = get_interface("cdr_cases/msg/Pair")
    message = pair(p=[Point(x=1.0), Point(y=2.0)], names=["a", "bcd"])
    assert deserialize(serialize(message), pair) == message


def test_big_endian() -> None:
    assert deserialize(BIG + struct.pack(">iI", 1, 2), Time) == Time(sec=1, nanosec=2)
    data = BIG + struct.pack(">3I", 2, 97, 0x20AC)
    assert deserialize(data, WString).data == "a€"


def test_any_buffer_is_accepted() -> None:
    data = serialize(LaserScan(ranges=[1.0, 2.0]))
    for buffer in (data, bytearray(data), memoryview(data)):
        assert deserialize(buffer, LaserScan).ranges.tolist() == [1.0, 2.0]


def test_decoded_arrays_are_writable_copies() -> None:
    data = bytearray(serialize(OccupancyGrid(data=[1, 2])))
    grid = deserialize(data, OccupancyGrid)
    data[-1] = 9
    grid.data[0] = 5
    assert grid.data.tolist() == [5, 2]


def test_only_padding_is_allowed_at_the_end() -> None:
    data = serialize(Bool(data=True))
    assert deserialize(data + b"\0\0\0", Bool).data is True
    with pytest.raises(DecodeError, match="4 of 9 bytes are unread"):
        deserialize(data + b"\0\0\0\0", Bool)


@pytest.mark.parametrize("head", [b"", b"\x00", b"\x00\x01\x00", b"\x00\x07\x00\x00ab"])
def test_other_headers_are_refused(head: bytes) -> None:
    with pytest.raises(DecodeError, match="expected plain CDR"):
        deserialize(head, String)


HUGE = struct.pack("<I", 2**32 - 1)


@pytest.mark.parametrize(
    ("body", "cls"),
    [
        (b"", Float64),
        (b"\x02", Bool),
        (HUGE, String),
        (HUGE + b"abc", UInt8MultiArray),
        (bytes(12) + HUGE, JointState),
        (HUGE, Polygon),
        (HUGE, WString),
        (struct.pack("<I", 3) + b"abc", String),  # no terminating zero
        (struct.pack("<I", 3) + b"\xff\xff\0", String),  # not UTF-8
        (struct.pack("<II", 1, 0x10000), WString),
        (struct.pack("<II", 1, 0xD800), WString),  # half a pair
    ],
)
def test_bad_bytes(body: bytes, cls: type) -> None:
    with pytest.raises(DecodeError):
        deserialize(LITTLE + body, cls)


def test_a_string_of_length_zero_is_empty() -> None:
    assert deserialize(LITTLE + bytes(4), String) == String()


def test_bounds_are_checked_on_reading() -> None:
    register_definition("cdr_cases/msg/Bounded", "string<=2 s\nint8[<=2] a\n")
    bounded = get_interface("cdr_cases/msg/Bounded")
    good = LITTLE + b"\x03\0\0\0ab\0\0" + struct.pack("<Ibb", 2, 1, 2)
    assert deserialize(good, bounded) == bounded(s="ab", a=[1, 2])
    with pytest.raises(DecodeError, match=r"Bounded\.s"):
        deserialize(LITTLE + b"\x04\0\0\0abc\0" + bytes(4), bounded)
    with pytest.raises(DecodeError, match=r"Bounded\.a"):
        deserialize(LITTLE + b"\x01\0\0\0\0\0\0\0" + b"\x03\0\0\0abc", bounded)


def test_bool_arrays_are_checked() -> None:
    data = bytearray(serialize(ParameterValue(bool_array_value=[True, False])))
    assert deserialize(data, ParameterValue).bool_array_value == [True, False]
    data[data.index(b"\x02\0\0\0\x01") + 4] = 3
    with pytest.raises(DecodeError, match=r"bool_array_value: 3 is not a bool"):
        deserialize(data, ParameterValue)


def test_octets_of_fixed_and_bounded_size() -> None:
    text = "bool[3] flags\nbyte[2] raw [1, 2]\nbool[<=2] few\nint64[<=2] numbers\n"
    register_definition("codec_cases/msg/Octets", text)
    octets = get_interface("codec_cases/msg/Octets")
    assert octets().raw == [b"\x01", b"\x02"]
    message = octets(flags=[True, False, True], few=[True], numbers=[-1])
    data = serialize(message)
    assert deserialize(data, octets) == message
    assert data[4:9] == b"\x01\0\x01\x01\x02"
    message.flags.append(True)
    with pytest.raises(MessageError, match=r"flags: 4 elements, expected exactly 3"):
        serialize(message)
    message = octets(numbers=[1, 2])
    message.numbers.append(3)
    with pytest.raises(MessageError, match=r"numbers: 3 elements, expected at most 2"):
        serialize(message)


@pytest.mark.parametrize(
    ("items", "what"), [([True, 2], "2 is int"), ([300], "300 is int"), (["a"], "str")]
)
def test_the_error_names_the_invalid_bool(items: list[Any], what: str) -> None:
    value = ParameterValue()
    value.bool_array_value.extend(items)
    with pytest.raises(MessageError, match=rf"bool_array_value\[\d\]: .*{what}"):
        serialize(value)


def test_the_error_names_the_invalid_byte() -> None:
    value = ParameterValue(byte_array_value=b"ab")
    value.byte_array_value.append(b"cd")
    with pytest.raises(MessageError, match=r"byte_array_value\[2\]: b'cd'"):
        serialize(value)


def test_numbers_that_end_before_their_length() -> None:
    data = serialize(Float64MultiArray(data=[1, 2, 3]))
    for cut in range(1, 25):
        with pytest.raises(DecodeError, match="length 3 exceeds"):
            deserialize(data[:-cut], Float64MultiArray)


def test_the_error_names_the_invalid_element() -> None:
    marker = Marker(points=[Point()])
    marker.points.append(3)  # type: ignore[arg-type]
    with pytest.raises(MessageError, match=r"Marker\.points\[1\]: 3 is int"):
        serialize(marker)
    state = JointState(name=["a"])
    state.name.append(b"b")  # type: ignore[arg-type]
    with pytest.raises(MessageError, match=r"JointState\.name\[1\]"):
        serialize(state)
    descriptor = ParameterDescriptor()
    ranges = descriptor.integer_range
    ranges += [type(descriptor).SLOT_TYPES] * 2  # type: ignore[list-item]
    with pytest.raises(MessageError, match="at most 1"):
        serialize(descriptor)


def test_half_a_surrogate_pair_is_refused() -> None:
    with pytest.raises(MessageError, match="String: a string is not valid Unicode"):
        serialize(String(data="\ud800"))


def test_only_message_classes() -> None:
    with pytest.raises(MessageError, match="not a message class"):
        deserialize(LITTLE, AddTwoInts)  # type: ignore[type-var]
    with pytest.raises(MessageError, match="not a message class"):
        serialize(3)  # type: ignore[arg-type]


def test_a_subclass_is_decoded_as_such() -> None:
    class Command(Twist):
        """A user's subclass."""

    assert type(deserialize(serialize(Command()), Command)) is Command
