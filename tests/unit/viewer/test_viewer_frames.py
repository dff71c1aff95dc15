"""Decoding of client frames and encoding of server frames."""

import json
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import DecodeError
from navette.viewer import frames, replies
from navette.viewer.frames import WireParameter, decode
from navette.viewer.replies import Channel, ConnectionGraph, Level


@pytest.mark.parametrize(
    ("document", "value"),
    [
        (
            {"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 3}]},
            frames.Subscribe(((0, 3),)),
        ),
        ({"op": "unsubscribe", "subscriptionIds": [0]}, frames.Unsubscribe((0,))),
        (
            {
                "op": "advertise",
                "channels": [
                    {
                        "id": 1,
                        "topic": "/goal_point",
                        "encoding": "json",
                        "schemaName": "geometry_msgs/PointStamped",
                    }
                ],
            },
            frames.Advertise(
                (
                    frames.ClientChannel(
                        1, "/goal_point", "json", "geometry_msgs/PointStamped"
                    ),
                )
            ),
        ),
        ({"op": "unadvertise", "channelIds": [1, 2]}, frames.Unadvertise((1, 2))),
        (
            {"op": "getParameters", "parameterNames": [], "id": "a"},
            frames.GetParameters((), "a"),
        ),
        (
            {
                "op": "setParameters",
                "parameters": [{"name": "/n.p", "value": 3, "type": "float64"}],
            },
            frames.SetParameters((WireParameter("/n.p", 3, "float64"),), None),
        ),
        (
            {"op": "subscribeParameterUpdates", "parameterNames": ["/n.p"]},
            frames.WatchParameters(("/n.p",)),
        ),
        (
            {"op": "unsubscribeParameterUpdates", "parameterNames": []},
            frames.UnwatchParameters(()),
        ),
        ({"op": "subscribeConnectionGraph"}, frames.WatchGraph(wanted=True)),
        ({"op": "unsubscribeConnectionGraph"}, frames.WatchGraph(wanted=False)),
        (
            {"op": "fetchAsset", "uri": "package://navette/x", "requestId": 7},
            frames.FetchAsset("package://navette/x", 7),
        ),
    ],
)
def test_text_frames_are_decoded(document: object, value: object) -> None:
    assert decode(json.dumps(document)) == value


def test_binary_frames_are_decoded() -> None:
    assert decode(b"\x01\x1e\x00\x00\x00abc") == frames.Publish(30, b"abc")
    call = b"\x02" + struct.pack("<III", 10, 12, 4) + b"json" + b"{}"
    assert decode(call) == frames.CallService(10, 12, "json", b"{}")


@pytest.mark.parametrize(
    ("frame", "complaint"),
    [
        ("{", "not JSON"),
        ("[1]", "not a JSON object"),
        ('{"op": "subscribe", "x": NaN}', "NaN is not JSON"),
        ("[" * 2000, "not JSON"),
        ("[" + "[]," * 3000 + "1]", "3001 lists and objects; at most 2500"),
        ("1" * 60_000, "not JSON"),
        ("[" * 100_000, "100000 bytes; at most 65536 are allowed"),
        (
            '{"op": "unsubscribe", "subscriptionIds": [' + "1," * 1000 + "1]}",
            "1001 entries in 'subscriptionIds' of unsubscribe; at most 1000",
        ),
        (
            json.dumps({"op": "getParameters", "parameterNames": ["a" * 1001]}),
            "'parameterNames' of 1001 characters; at most 1000",
        ),
        (
            struct.pack("<BBfBQI", 3, 0, 1.0, 0, 0, 1001) + b"a" * 1001,
            "request id of 1001 characters",
        ),
        ('{"op": "dance"}', "unknown op 'dance'; known: subscribe"),
        ('{"op": ["subscribe"]}', "unknown op"),
        ('{"op": "subscribe"}', "'subscriptions' has None, not a list"),
        ('{"op": "subscribe", "subscriptions": [1]}', "list of objects"),
        (
            '{"op": "subscribe", "subscriptions": [{"id": true, "channelId": 1}]}',
            "'id' has True, not a number",
        ),
        ('{"op": "unsubscribe", "subscriptionIds": [-1]}', "not a uint32"),
        ('{"op": "unsubscribe", "subscriptionIds": [1.5]}', "not a number"),
        ('{"op": "getParameters", "parameterNames": [1]}', "not a list of strings"),
        ('{"op": "fetchAsset", "uri": 1, "requestId": 1}', "'uri' has 1, not a string"),
        (b"", "empty"),
        (b"\x09", "unknown binary opcode 9"),
        (b"\x01\x00", "truncated"),
        (b"\x02" + struct.pack("<III", 1, 1, 2**31), "truncated"),
    ],
)
def test_bad_frames_are_named(frame: str | bytes, complaint: str) -> None:
    with pytest.raises(DecodeError, match=complaint):
        decode(frame)


def complaint_about(frame: str | bytes) -> str:
    """The decode error's text; empty where the frame is good."""
    try:
        decode(frame)
    except DecodeError as error:
        return str(error)
    return ""


@given(st.one_of(st.text(), st.binary()))
def test_any_frame_is_decoded_or_refused(frame: str | bytes) -> None:
    assert len(complaint_about(frame)) < 500


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(
                ["id", "channelId", "channels", "subscriptions", "parameterNames"]
            ),
            inner,
            max_size=3,
        )
    ),
)


@given(st.sampled_from(sorted(frames._TEXT)), json_values)
def test_any_json_frame_is_decoded_or_refused(op: str, value: object) -> None:
    fields = value if isinstance(value, dict) else {"channels": value}
    complaint = complaint_about(json.dumps({"op": op, **fields}))
    assert not complaint or op in complaint


def test_server_info_has_the_ros_distribution_and_capabilities() -> None:
    info = json.loads(replies.server_info("Navette", "abc"))
    assert info["metadata"] == {"ROS_DISTRO": "jazzy"}
    assert info["sessionId"] == "abc"
    assert "services" in info["capabilities"]
    assert info["supportedEncodings"] == ["cdr", "json"]


def test_advertise_carries_the_definition() -> None:
    channel = Channel(3, "/chatter", "std_msgs/msg/String", "string data\n")
    assert json.loads(replies.advertise([channel]))["channels"] == [
        {
            "id": 3,
            "topic": "/chatter",
            "encoding": "cdr",
            "schemaName": "std_msgs/msg/String",
            "schemaEncoding": "ros2msg",
            "schema": "string data\n",
        }
    ]


def test_binary_replies_have_the_published_form() -> None:
    assert replies.message_head(7, 2**40) + b"xy" == (
        b"\x01" + struct.pack("<IQ", 7, 2**40) + b"xy"
    )
    assert replies.time(5) == b"\x02" + struct.pack("<Q", 5)
    assert replies.asset(9, b"data") == b"\x04" + struct.pack("<IBI", 9, 0, 0) + b"data"
    assert replies.asset_error(9, "é") == (
        b"\x04" + struct.pack("<IBI", 9, 1, 2) + "é".encode()
    )


def test_status_levels_are_numbers() -> None:
    status = json.loads(replies.status(Level.WARNING, "hm"))
    assert status == {"op": "status", "level": 1, "message": "hm"}


def test_unset_parameters_have_no_value() -> None:
    frame = replies.parameter_values([WireParameter("/n.p", None)], None)
    assert json.loads(frame) == {
        "op": "parameterValues",
        "parameters": [{"name": "/n.p"}],
    }


def test_graph_updates_hold_only_what_changed() -> None:
    old = ConnectionGraph(
        {"/a": ("/n1",), "/b": ("/n1",)}, {"/a": ("/n2",), "/c": ("/n2",)}
    )
    new = ConnectionGraph(
        {"/a": ("/n1",), "/d": ("/n3",)}, {"/a": ("/n2", "/n3"), "/b": ("/n4",)}
    )
    update = replies.graph_update(old, new)
    assert update is not None
    assert json.loads(update) == {
        "op": "connectionGraphUpdate",
        "publishedTopics": [
            {"name": "/b", "publisherIds": []},
            {"name": "/d", "publisherIds": ["/n3"]},
        ],
        "subscribedTopics": [
            {"name": "/a", "subscriberIds": ["/n2", "/n3"]},
            {"name": "/b", "subscriberIds": ["/n4"]},
        ],
        "advertisedServices": [],
        "removedTopics": ["/c"],
        "removedServices": [],
    }
    assert replies.graph_update(new, new) is None
