"""Decoding of messages from clients; invalid input is refused."""

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import DecodeError, MessageError, NavetteError
from navette.files.untrusted.budget import BudgetError
from navette.msgs import serialize
from navette.msgs.geometry_msgs.msg import PointStamped, PoseStamped, Twist
from navette.msgs.nav_msgs.msg import Path
from navette.msgs.sensor_msgs.msg import Image, LaserScan
from navette.msgs.std_msgs.msg import String
from navette.viewer.publishing import decode_message
from navette.viewer.replies import ConnectionGraph
from navette.viewer.session import Topic
from navette.viewer.topic_ends import TopicEnd, graph_of, topics_of

STRING = "std_msgs/msg/String"


def test_json_may_omit_fields_and_use_either_stamp_form() -> None:
    document = {"poses": [{"header": {"stamp": {"sec": 1, "nsec": 5}}}]}
    path = decode_message("json", Path, json.dumps(document).encode())
    assert isinstance(path, Path)
    assert path.poses[0].header.stamp.nanosec == 5
    document["poses"][0]["header"]["stamp"] = {"sec": 1, "nanosec": 6}
    path = decode_message("json", Path, json.dumps(document).encode())
    assert isinstance(path, Path)
    assert path.poses[0].header.stamp.nanosec == 6


@pytest.mark.parametrize("data", [b"{", b"[]", b"\xff\xfe", b"[" * 9000])
def test_invalid_json_is_refused(data: bytes) -> None:
    with pytest.raises(DecodeError, match="JSON"):
        decode_message("json", Twist, data)


def test_text_that_is_not_unicode_is_refused() -> None:
    with pytest.raises(MessageError, match="not valid Unicode"):
        decode_message("json", String, b'{"data": "\\ud800"}')


@pytest.mark.parametrize(
    ("encoding", "message", "limit"),
    [
        ("cdr", Path(poses=[PoseStamped()] * 6000), "262144 are allowed"),
        ("cdr", Image(data=bytes(3_000_000)), ""),
        ("json", {"data": "a" * 300_000}, "262144 are allowed"),
        ("json", {"data": [[0, 1]] * 20_000}, "20002 lists and objects; at most"),
        ("json", {"data": [0] * 110_000}, "100000 items"),
    ],
)
def test_messages_are_bounded_by_what_they_cost(
    encoding: str, message: Any, limit: str
) -> None:
    """Plain arrays are decoded at once; lists of objects one by one."""
    if encoding == "cdr":
        cls, data = type(message), serialize(message)
    else:
        cls, data = String, json.dumps(message, separators=(",", ":")).encode()
    if limit:
        with pytest.raises(NavetteError, match=limit):
            decode_message(encoding, cls, data)
    else:
        assert decode_message(encoding, cls, data) == message


def test_deeply_nested_json_is_refused() -> None:
    deep = b'{"data": ' + b"[" * 500 + b"]" * 500 + b"}"
    with pytest.raises(BudgetError, match="nested deeper than 32"):
        decode_message("json", String, deep)


@pytest.mark.parametrize(
    "document",
    [
        {"linear": {"x": "fast"}},
        {"linear": {"x": None}},
        {"linear": 1},
        {"velocity": 1},
        {"linear": {"x": [1]}},
    ],
)
def test_wrong_fields_are_named(document: object) -> None:
    with pytest.raises(MessageError, match=r"Twist|Vector3"):
        decode_message("json", Twist, json.dumps(document).encode())


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(
                ["header", "stamp", "sec", "nanosec", "nsec", "ranges", "point", "x"]
            ),
            inner,
            max_size=3,
        )
    ),
    max_leaves=8,
)


@given(json_values)
def test_any_json_is_decoded_or_refused(value: object) -> None:
    for cls in (PointStamped, LaserScan):
        try:
            decode_message("json", cls, json.dumps(value).encode())
        except NavetteError as error:
            assert str(error)  # noqa: PT017 - any of ours will do, nothing else


@given(st.binary(max_size=80), st.integers(0, 60))
def test_any_cdr_is_decoded_or_refused(data: bytes, cut: int) -> None:
    whole = serialize(LaserScan(ranges=[1.0, 2.0]))
    for payload in (data, b"\0\1\0\0" + data, whole[:cut] + data):
        try:
            decode_message("cdr", LaserScan, payload)
        except NavetteError as error:
            assert str(error)  # noqa: PT017 - any of ours will do, nothing else


def test_topics_are_shown_once_per_type_latched_if_any_publisher_is() -> None:
    ends = [
        TopicEnd("/map", STRING, "/planner", publishes=False, latched=True),
        TopicEnd("/map", STRING, "/memory", publishes=True, latched=True),
        TopicEnd("/map", STRING, "/other", publishes=True),
        TopicEnd("/scan", STRING, "/costmap", publishes=False, latched=True),
        TopicEnd("/odd", "absent_msgs/msg/Absent", "/odd", publishes=True),
    ]
    known = {STRING: "string data"}
    assert topics_of(ends, lambda _, type_name: known.get(type_name)) == [
        Topic("/map", STRING, "string data", latched=True),
        Topic("/scan", STRING, "string data", latched=False),
    ]
    assert graph_of(ends) == ConnectionGraph(
        {"/map": ("/memory", "/other"), "/odd": ("/odd",)},
        {"/map": ("/planner",), "/scan": ("/costmap",)},
    )
