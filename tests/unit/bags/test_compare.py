"""Comparison of two recordings."""

import math

import pytest
from memory_source import MemorySource, S, recorded, topic_of

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.compare import Comparison, Tolerances, TopicComparison, compare
from navette.errors import InvalidValueError
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import Point, PointStamped, Pose, PoseStamped
from navette.msgs.nav_msgs.msg import OccupancyGrid, Path
from navette.msgs.std_msgs.msg import Float64, Header, Int64, String, UInt64

POINT = topic_of("/point", PointStamped)
NUMBER = topic_of("/number", Float64)
GRID = topic_of("/grid", OccupancyGrid)
PATH = topic_of("/path", Path)
TEXT = topic_of("/text", String)


def pair(
    topic: BagTopic, a: object, b: object, *rules: str, time_tolerance_s: float = 0.0
) -> TopicComparison:
    """One message each, at the same time."""
    (found,) = against(
        [recorded(topic, 1.0, a)],
        [recorded(topic, 1.0, b)],
        *rules,
        tolerance_s=time_tolerance_s,
    ).topics
    return found


def against(
    a: list[BagMessage], b: list[BagMessage], *rules: str, tolerance_s: float = 0.0
) -> Comparison:
    return compare(
        MemorySource(a),
        MemorySource(b),
        tolerances=Tolerances.parse(rules),
        time_tolerance_ns=round(tolerance_s * S),
    )


def numbers(*stamps: float, value: float = 0.0) -> list[BagMessage]:
    return [recorded(NUMBER, s, Float64(data=value)) for s in stamps]


def test_equal_recordings_are_the_same() -> None:
    found = against(numbers(1, 2, 3), numbers(1, 2, 3))
    assert found.same
    assert found.topics[0].compared == 3


def test_a_number_that_differs_is_named_with_its_field() -> None:
    a = PointStamped(point=Point(x=1.0, y=2.0))
    b = PointStamped(point=Point(x=1.0, y=2.5))
    found = pair(POINT, a, b)
    assert (found.compared, found.differing, found.same) == (1, 1, False)
    (field,) = found.fields.values()
    assert field.path == "point.y"
    assert field.first_ns == S
    assert field.worst is not None
    assert field.worst.largest == 0.5
    assert (field.worst.expected, field.worst.got) == ("2", "2.5")


@pytest.mark.parametrize(
    ("rules", "same"),
    [
        (["0.5"], True),
        (["0.4"], False),
        (["/point=0.5"], True),
        (["/point.point=0.5"], True),
        (["/point.point.y=0.5"], True),
        (["/point.point.x=0.5"], False),
        (["/point.poin=0.5"], False),
        (["/other=0.5"], False),
        (["*.y=0.5"], True),
        (["9", "/point.point.y=0.1"], False),
        (["/point.point.y=0.1", "9"], True),
    ],
)
def test_the_last_matching_tolerance_applies(rules: list[str], same: bool) -> None:
    a = PointStamped(point=Point(y=2.0))
    b = PointStamped(point=Point(y=2.5))
    assert pair(POINT, a, b, *rules).same is same


@pytest.mark.parametrize(
    "text", ["", "x", "=1", "/a=", "/a=x", "/a=-1", "nan", "1:2", "1:x%"]
)
def test_invalid_tolerances_are_refused(text: str) -> None:
    with pytest.raises(InvalidValueError, match="tolerance"):
        Tolerances.parse([text])


def test_a_share_of_an_array_may_differ() -> None:
    a = OccupancyGrid(data=[0] * 100)
    b = OccupancyGrid(data=[0] * 98 + [7, 3])
    found = pair(GRID, a, b)
    (field,) = found.fields.values()
    assert field.worst is not None
    assert (field.path, field.worst.differing, field.worst.elements) == (
        "data[]",
        2,
        100,
    )
    assert field.worst.largest == 7
    assert pair(GRID, a, b, "/grid.data=0:2%").same
    assert not pair(GRID, a, b, "/grid.data=0:1%").same
    assert pair(GRID, a, b, "/grid.data=3:1%").same
    assert pair(GRID, a, b, "/grid.data[]=7").same


def test_messages_in_sequences_are_one_field() -> None:
    def path(*xs: float) -> Path:
        return Path(poses=[PoseStamped(pose=Pose(position=Point(x=x))) for x in xs])

    found = pair(PATH, path(1, 2, 3), path(1, 2.5, 4))
    (field,) = found.fields.values()
    assert field.worst is not None
    assert field.path == "poses[].pose.position.x"
    assert (field.worst.differing, field.worst.elements) == (2, 3)
    assert field.worst.largest == 1.0
    (field,) = pair(PATH, path(1, 2), path(1)).fields.values()
    assert field.worst is not None
    assert (field.path, field.worst.expected, field.worst.got) == (
        "poses[]",
        "2 elements",
        "1 elements",
    )


def test_times_differ_by_seconds_to_the_nanosecond() -> None:
    def at(sec: int, nanosec: int) -> PointStamped:
        return PointStamped(header=Header(stamp=Time(sec=sec, nanosec=nanosec)))

    a, b = at(1_700_000_000, 999_999_999), at(1_700_000_001, 0)
    (field,) = pair(POINT, a, b).fields.values()
    assert field.worst is not None
    assert (field.path, field.worst.largest) == ("header.stamp", 1e-9)
    assert pair(POINT, a, b, "/point.header.stamp=1e-9").same


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        (math.nan, math.nan, True),
        (math.inf, math.inf, True),
        (math.inf, -math.inf, False),
        (math.nan, 0.0, False),
        (0.0, math.inf, False),
        (0.0, -0.0, True),
    ],
)
def test_no_tolerance_applies_to_infinity_and_nan(
    a: float, b: float, same: bool
) -> None:
    assert pair(NUMBER, Float64(data=a), Float64(data=b), "1e300").same is same


def test_text_is_compared_exactly() -> None:
    (field,) = pair(TEXT, String(data="a"), String(data="b" * 99), "9").fields.values()
    assert field.worst is not None
    assert field.worst.largest is None
    assert len(field.worst.got) == 60


def test_missing_and_additional_messages_are_counted() -> None:
    (found,) = against(numbers(1, 2, 3, 5), numbers(1, 2.5, 3, 4, 5)).topics
    assert (found.compared, found.missing, found.extra) == (3, 1, 2)
    assert not found.same


def test_stamps_may_differ_within_the_tolerance() -> None:
    (found,) = against(
        numbers(1, 2, 3), numbers(1.04, 1.97, 3.2), tolerance_s=0.05
    ).topics
    assert (found.compared, found.missing, found.extra) == (2, 1, 1)


@pytest.mark.parametrize("tolerance_s", [0.0, 0.04, 0.05, 0.2])
def test_one_missing_message_does_not_shift_the_others(tolerance_s: float) -> None:
    a = [recorded(NUMBER, 0.05 * i, Float64(data=float(i))) for i in range(40)]
    (found,) = against(a, a[1:], tolerance_s=tolerance_s).topics
    assert (found.compared, found.missing, found.extra) == (39, 1, 0)
    assert found.differing == 0


@pytest.mark.parametrize(("kind", "a"), [(Int64, -(2**62)), (UInt64, 2**64 - 5)])
def test_large_whole_numbers_are_compared_exactly(kind: type, a: int) -> None:
    topic = topic_of("/whole", kind)
    found = pair(topic, kind(data=a), kind(data=a + 1))
    (summary,) = found.fields.values()
    assert (summary.worst.expected, summary.worst.got) == (str(a), str(a + 1))
    assert pair(topic, kind(data=a), kind(data=a + 1), "/whole=1").same


def test_messages_of_one_stamp_are_matched_in_order() -> None:
    a = [recorded(NUMBER, 1.0, Float64(data=float(i))) for i in range(3)]
    assert against(a, list(a)).same
    (found,) = against(a, a[::-1]).topics
    assert (found.compared, found.differing) == (3, 2)


def test_a_missing_topic_is_a_difference_and_a_new_one_is_listed() -> None:
    found = against(numbers(1, 2), [recorded(TEXT, 1.0, String())])
    assert found.topics[0].missing == 2
    assert found.unexpected == ("/text",)
    assert not found.same


def test_another_type_is_named() -> None:
    other = recorded(topic_of("/number", String), 1.0, String())
    (found,) = against(numbers(1), [other]).topics
    assert found.problem == "type std_msgs/msg/Float64 became std_msgs/msg/String"
    assert not found.same


def test_other_fields_of_the_same_type_are_named() -> None:
    old = BagTopic("/number", "std_msgs/msg/Float64", "float64 data\nfloat64 more\n")
    data = b"\x00\x01\x00\x00" + bytes(16)
    (found,) = against([BagMessage(old, S, data)], numbers(1)).topics
    assert "different fields" in found.problem


def test_invalid_bytes_are_reported() -> None:
    broken = BagMessage(TEXT, S, b"\x00\x01\x00\x00\xff")
    (found,) = against([recorded(TEXT, 1.0, String(data="a"))], [broken]).topics
    assert found.problem.startswith("at 1.000 s: ")


def test_messages_of_a_silent_node_are_not_distinguished_from_those_of_others() -> None:
    paths = [recorded(TEXT, 1.0, String(data="of another node"))]
    compared = [*numbers(1), *paths]

    def result(got: list[BagMessage], *shared: str) -> Comparison:
        return compare(MemorySource(compared), MemorySource(got), shared=shared)

    assert not result(numbers(1)).same
    found = result(numbers(1), "/text")
    assert found.same
    assert found.of_others == ("/text",)
    assert [topic.name for topic in found.topics] == ["/number"]
    # What the node published itself is compared, and what is missing counts.
    wrong = [*numbers(1), recorded(TEXT, 1.0, String(data="of the node"))]
    assert not result(wrong, "/text").same
    assert result(compared, "/text").topics[1].compared == 1


def test_a_recording_without_messages_of_a_node_agrees_with_its_silence() -> None:
    def result(got: list[BagMessage]) -> Comparison:
        return compare(MemorySource(numbers(1)), MemorySource(got), topics=["/text"])

    found = result([])
    assert found.same
    assert not found.topics
    with pytest.raises(InvalidValueError, match="no messages on /text; was the node"):
        result([recorded(TEXT, 1.0, String(data="new"))])


def test_the_name_of_the_player_stands_for_those_of_the_recorded_nodes() -> None:
    def differs(got: str) -> bool:
        tolerances = Tolerances(stand_in="/replay")
        found = compare(
            MemorySource([recorded(TEXT, 1.0, String(data="/behaviors,/control"))]),
            MemorySource([recorded(TEXT, 1.0, String(data=got))]),
            tolerances=tolerances,
        )
        return not found.same

    assert not differs("/replay")
    assert differs("/other")
    assert differs("")
