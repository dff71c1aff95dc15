"""The live view and independent peers: two ROS 2 decoders and Foxglove's server."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import foxglove
import numpy as np
import pytest
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from navette.msgs import get_interface
from navette.runtime import Context, Node

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Client, Program

SHOWN = {
    "/lidar": "sensor_msgs/msg/LaserScan",
    "/imu": "sensor_msgs/msg/Imu",
    "/camera": "sensor_msgs/msg/Image",
    "/camera_info": "sensor_msgs/msg/CameraInfo",
    "/odom/filtered": "nav_msgs/msg/Odometry",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/clock": "rosgraph_msgs/msg/Clock",
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/path": "nav_msgs/msg/Path",
    "/goal_point": "geometry_msgs/msg/PointStamped",
    "/cmd_vel": "geometry_msgs/msg/Twist",
    "/planner/status": "diagnostic_msgs/msg/DiagnosticStatus",
    "/gnss_driver/odometry": "gnss_driver/msg/Gps",
    "/points": "sensor_msgs/msg/PointCloud2",
    "/markers": "visualization_msgs/msg/MarkerArray",
}


class Robot(Node):
    """Publishes messages of every displayed type repeatedly."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        for topic, type_name in SHOWN.items():
            self.repeat(topic, example_of(type_name))

    def repeat(self, topic: str, message: Any) -> None:
        publisher = self.create_publisher(type(message), topic, 10)
        self.create_timer(0.02, lambda: publisher.publish(message))


def example_of(type_name: str) -> Any:
    """Return a message with a non-empty header and arrays."""
    message = get_interface(type_name)()
    fields = message.get_fields_and_field_types()
    if "header" in fields:
        message.header.frame_id = "frame é"
        message.header.stamp.nanosec = 7
    for name, kind in fields.items():
        if kind in ("sequence<float>", "sequence<double>"):
            setattr(message, name, [1.5, -2.5])
        elif kind in ("sequence<uint8>", "sequence<int8>"):
            setattr(message, name, [1, 2, 3])
    if type_name == "tf2_msgs/msg/TFMessage":
        transform = get_interface("geometry_msgs/msg/TransformStamped")()
        transform.child_frame_id = "base_link"
        message.transforms = [transform, transform]
    return message


@pytest.fixture(scope="module")
def program() -> Iterator[Program]:
    with Program(Robot) as running:
        yield running


def received(program: Program, topic: str) -> tuple[dict[str, Any], bytes]:
    with Client(program.address) as client:
        channel = client.subscribe(topic, 1)
        return channel, client.message(1)[1]


@pytest.mark.parametrize("topic", SHOWN)
def test_mcap_ros2_decodes_what_was_sent(program: Program, topic: str) -> None:
    channel, payload = received(program, topic)
    schema = Schema(
        id=1,
        name=channel["schemaName"],
        encoding=channel["schemaEncoding"],
        data=channel["schema"].encode(),
    )
    decode = DecoderFactory().decoder_for(channel["encoding"], schema)
    assert decode is not None
    assert_same(decode(payload), example_of(SHOWN[topic]))


@pytest.mark.parametrize("topic", SHOWN)
def test_rosbags_decodes_what_was_sent(program: Program, topic: str) -> None:
    channel, payload = received(program, topic)
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(channel["schema"], channel["schemaName"]))
    assert_same(
        store.deserialize_cdr(payload, channel["schemaName"]),
        example_of(SHOWN[topic]),
    )


def assert_same(other: Any, ours: Any) -> None:
    """Compare recursively, field by field."""
    if hasattr(ours, "get_fields_and_field_types"):
        for name in ours.get_fields_and_field_types():
            assert_same(getattr(other, name), getattr(ours, name))
    elif isinstance(ours, bytes):
        assert other in (ours, ours[0])
    elif isinstance(ours, str | int | float):
        assert other == ours
    else:
        assert len(other) == len(ours)
        for one, two in zip(other, ours, strict=True):
            assert_same(one, two.item() if isinstance(two, np.generic) else two)


# -- Foxglove's own server ------------------------------------------------------------


@pytest.fixture(scope="module")
def reference() -> Iterator[str]:
    """Address of a foxglove-sdk server with one ROS 2 topic, published continuously."""
    context = foxglove.Context()
    server = foxglove.start_server(
        context=context,
        host="127.0.0.1",
        port=0,
        capabilities=[
            foxglove.Capability.ClientPublish,
            foxglove.Capability.Parameters,
            foxglove.Capability.ConnectionGraph,
            foxglove.Capability.Time,
        ],
        supported_encodings=["cdr", "json"],
        server_listener=ParameterOwner(),
    )
    foxglove.Channel(
        "/clock",
        message_encoding="cdr",
        schema=foxglove.Schema(
            name="rosgraph_msgs/msg/Clock", encoding="ros2msg", data=b"string data"
        ),
        context=context,
    )
    yield f"127.0.0.1:{server.port}"
    server.stop()


class ParameterOwner(foxglove.ServerListener):
    def on_get_parameters(
        self, client: Any, param_names: list[str], request_id: str | None = None
    ) -> list[foxglove.Parameter]:
        return [foxglove.Parameter("/robot.speed_mps", value=1.5)]


def conversation(address: str) -> dict[str, Any]:
    """Send the same requests to either server; return one response of each kind."""
    with Client(address, "foxglove.sdk.v1") as client:
        channel = client.wait_for_topic("/clock")
        client.send(op="getParameters", parameterNames=["/robot.speed_mps"], id="a")
        parameters = client.wait_for_op("parameterValues")
        client.send(op="subscribe", subscriptions=[{"id": 1, "channelId": 4000000}])
        unknown_channel = client.wait_for_op("status")
        client.socket.send("{")
        bad_json = client.wait_for_op("status")
        client.publish(9, b"x")
        not_advertised = client.wait_for_op("status")
        return {
            "serverInfo": client.info,
            "channel": channel,
            "parameterValues": parameters,
            "unknownChannel": unknown_channel,
            "badJson": bad_json,
            "notAdvertised": not_advertised,
        }


def test_frames_have_the_form_of_the_foxglove_server(reference: str) -> None:
    theirs = conversation(reference)
    theirs["serverInfo"].pop("metadata")  # library name, ROS distribution
    with Program(SpeedyRobot) as program:
        ours = conversation(program.address)
    for name, frame in theirs.items():
        assert shape(ours[name], frame) == shape(frame, frame), name
    capabilities = set(ours["serverInfo"]["capabilities"])
    assert set(theirs["serverInfo"]["capabilities"]) <= capabilities


class SpeedyRobot(Robot):
    """Robot with the parameter of the reference server."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.declare_parameter("speed_mps", 1.5)


_CODES = ("op", "level", "encoding", "schemaEncoding", "type")


def shape(frame: Any, model: Any) -> Any:
    """Return the keys and JSON types of ``model``; values only of codes."""
    if isinstance(model, dict):
        if not isinstance(frame, dict):
            return type(frame).__name__
        return {
            key: frame.get(key) if key in _CODES else shape(frame.get(key), model[key])
            for key in model
        }
    if isinstance(model, list) and isinstance(frame, list):
        return [shape(frame[0], model[0])] if frame and model else []
    return type(frame).__name__
