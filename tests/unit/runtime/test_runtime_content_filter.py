"""Content filters: messages that pass, errors of an expression."""

from typing import Any

import pytest

from navette.errors import InvalidValueError
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.rcl_interfaces.msg import Log
from navette.msgs.sensor_msgs.msg import CameraInfo, LaserScan
from navette.msgs.std_msgs.msg import Bool, Int32, String
from navette.runtime import Node, QoSProfile
from navette.runtime.exceptions import RCLError
from navette.runtime.filter_expression import ContentFilterError, compile_filter
from navette.runtime.subscription import ContentFilterOptions
from navette.runtime.testing import GraphHarness

POINT = PointStamped()
POINT.header.frame_id = "map"
POINT.header.stamp.sec = 7
POINT.point.x, POINT.point.y = 1.5, -2.0


@pytest.mark.parametrize(
    ("expression", "parameters", "passes"),
    [
        ("point.x > 1", [], True),
        ("point.x = 1.5", [], True),
        ("point.x <> 1.5", [], False),
        ("point.x != %0", ["1.5"], False),
        ("-2e0 >= point.y", [], True),
        ("point.y < point.x", [], True),
        ("header.stamp.sec = 0x7", [], True),
        ("header.frame_id = 'map'", [], True),
        ("header.frame_id = %1", ["1", "'odom'"], False),
        ("header.frame_id like 'm_p'", [], True),
        ("header.frame_id LIKE '%a%'", [], True),
        ("header.frame_id LIKE 'm.p'", [], False),
        ("header.frame_id MATCH '[a-z]+'", [], True),
        ("header.frame_id MATCH 'm'", [], False),
        ("point.x BETWEEN 1 AND 2", [], True),
        ("point.x NOT BETWEEN %0 AND %1", ["1", "2"], False),
        ("point.x < 0 OR point.y < 0 AND point.x > 1", [], True),
        ("(point.x < 0 OR point.y < 0) AND point.x > 9", [], False),
        ("NOT point.x < 0 and not (point.y > 0)", [], True),
        ("NOT " * 99 + "(point.x < 0)", [], True),
        ("point.x < 0 OR NOT (" * 50 + "point.y < 0" + ")" * 50, [], True),
    ],
)
def test_expressions(expression: str, parameters: list[str], passes: bool) -> None:
    assert compile_filter(expression, parameters, PointStamped)(POINT) is passes


def test_other_types_of_fields() -> None:
    assert compile_filter("data = TRUE", [], Bool)(Bool(data=True))
    assert compile_filter("data <> %0", ["false"], Bool)(Bool(data=True))
    status = DiagnosticStatus(level=b"\x02", values=[KeyValue(key="a", value="b")])
    assert compile_filter("level >= 2", [], DiagnosticStatus)(status)
    assert compile_filter("values[0].key = 'a'", [], DiagnosticStatus)(status)
    assert not compile_filter("values[1].key = 'a'", [], DiagnosticStatus)(status)
    assert compile_filter("ranges[1] < 3", [], LaserScan)(LaserScan(ranges=[9, 1]))
    assert compile_filter("k[8] = 0", [], CameraInfo)(CameraInfo())
    assert compile_filter("level = 40", [], Log)(Log(level=40))


@pytest.mark.parametrize(
    ("expression", "parameters", "reason"),
    [
        (
            "point.w > 1",
            [],
            r"'point.w': geometry_msgs/Point has no such field; known: x, y, z",
        ),
        ("point > 1", [], "point is a geometry_msgs/Point, not a number"),
        ("point.x.y > 1", [], "float64 has no fields"),
        ("point.x[0] > 1", [], "float64 is not an array"),
        ("point.x > 'a'", [], "point.x is a number, 'a' is a string"),
        ("point.x > TRUE", [], "TRUE is a bool"),
        ("point.x LIKE '1'", [], "is a number"),
        ("header.frame_id LIKE header.frame_id", [], "with a quoted string"),
        ("header.frame_id MATCH '['", [], "unterminated character set"),
        ("point.x > %1", ["1"], "%1: only 1 parameters given"),
        ("header.frame_id = %0", ["map"], "%0 is 'map'; allowed: .* single quotes"),
        ("point.x >", [], "unexpected end at column 9; .* a field, a number"),
        ("point.x 3", [], "unexpected '3' at column 9; expected = <>"),
        ("point.x NOT 3", [], "expected BETWEEN"),
        ("(point.x > 3", [], r"unexpected end at column 12; expected \)"),
        ("point.x > 3 point.y", [], "unexpected 'point.y' at column 13; expected .*OR"),
        ("AND", [], "unexpected end"),
        ("point.x > 3 ; drop", [], "unexpected character at column 13"),
        ("(" * 101 + "point.x > 1" + ")" * 101, [], "more than 100 parentheses"),
        ("x" * 5000, [], "5000 characters; at most 4096"),
    ],
)
def test_errors_name_the_problem(
    expression: str, parameters: list[str], reason: str
) -> None:
    with pytest.raises(ContentFilterError, match=reason):
        compile_filter(expression, parameters, PointStamped)
    assert issubclass(ContentFilterError, (RCLError, InvalidValueError))


def node(graph: GraphHarness, name: str) -> Node:
    return graph.add(Node(name, context=graph.context))


def collected(graph: GraphHarness, **options: Any) -> tuple[Any, Any, list[int]]:
    publisher = node(graph, "talker").create_publisher(Int32, "numbers", 10)
    received: list[int] = []
    subscription = node(graph, "listener").create_subscription(
        Int32,
        "numbers",
        lambda m: received.append(m.data),
        QoSProfile(depth=2),
        **options,
    )
    return publisher, subscription, received


def test_a_filter_can_be_set_changed_and_removed(graph: GraphHarness) -> None:
    publisher, subscription, received = collected(graph)
    assert not subscription.is_cft_enabled
    assert subscription.get_content_filter() == ContentFilterOptions("", [])
    subscription.set_content_filter("data > %0", ["15"])
    assert subscription.is_cft_enabled
    assert subscription.get_content_filter() == ("data > %0", ["15"])
    # A message that does not pass takes no queue slot.
    for number in (20, 1, 2, 30, 3, 4):
        publisher.publish(Int32(data=number))
    graph.run_for(0.1)
    assert received == [20, 30]
    with pytest.raises(ContentFilterError):
        subscription.set_content_filter("nonsense")
    assert subscription.is_cft_enabled  # the previous filter stays
    subscription.set_content_filter("", [])
    assert not subscription.is_cft_enabled
    for number in (1, 2, 3):
        publisher.publish(Int32(data=number))
    graph.run_for(0.1)
    assert received == [20, 30, 2, 3]


def test_a_filter_from_the_start_with_a_full_queue(graph: GraphHarness) -> None:
    publisher, subscription, received = collected(
        graph, content_filter_options=ContentFilterOptions("data > %0", ["0"])
    )
    assert subscription.is_cft_enabled
    for number in (1, 2, -1, 3):
        publisher.publish(Int32(data=number))
    graph.run_for(0.1)
    assert received == [2, 3]


def test_an_invalid_filter_creates_no_subscription(graph: GraphHarness) -> None:
    made = node(graph, "n")
    options = ContentFilterOptions("nope = 1", [])
    with pytest.raises(ContentFilterError, match="'nope': std_msgs/String has no such"):
        made.create_subscription(String, "x", print, 1, content_filter_options=options)
    assert made.count_subscribers("x") == 0


def test_raw_subscriptions_filter_by_the_decoded_message(graph: GraphHarness) -> None:
    publisher = node(graph, "talker").create_publisher(Int32, "numbers", 10)
    received: list[bytes] = []
    node(graph, "listener").create_subscription(
        Int32,
        "numbers",
        received.append,
        10,
        raw=True,
        content_filter_options=ContentFilterOptions("data = 1", []),
    )
    for number in (1, 2):
        publisher.publish(Int32(data=number))
    graph.run_for(0.1)
    assert [data[4:] for data in received] == [b"\x01\0\0\0"]
