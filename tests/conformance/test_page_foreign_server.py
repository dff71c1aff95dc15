"""The page at a Foxglove server of another make: the server of Foxglove's SDK."""

import shutil
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import foxglove
import numpy as np
import pytest
from foxglove.websocket import (
    Capability,
    MessageSchema,
    Parameter,
    ServerListener,
    Service,
    ServiceSchema,
)
from test_viewer_javascript import run_node

from navette.msgs import definition_text, deserialize, serialize
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.std_msgs.msg import Header
from navette.runtime import Context, Node

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Program

pytestmark = pytest.mark.long

BATTERY = {"type": "object", "properties": {"charge": {"type": "number"}}}
NUMBER = b"int64 data\n"


class Listener(ServerListener):  # type: ignore[misc]
    """Keeps what the page sends."""

    def __init__(self) -> None:
        self.published: list[bytes] = []
        self.parameters = {"speed": 1.5}

    def on_message_data(self, client: Any, client_channel_id: int, data: bytes) -> None:
        self.published.append(data)

    def on_get_parameters(
        self, client: Any, param_names: list[str], request_id: str | None = None
    ) -> list[Any]:
        return [Parameter(name, value=each) for name, each in self.parameters.items()]

    def on_set_parameters(
        self, client: Any, parameters: list[Any], request_id: str | None = None
    ) -> list[Any]:
        for each in parameters:
            self.parameters[each.name] = each.get_value()
        return parameters


def double(request: Any) -> bytes:
    (value,) = struct.unpack_from("<q", request.payload, 4)
    return b"\0\1\0\0" + struct.pack("<q", 2 * value)


@pytest.fixture
def other() -> Iterator[tuple[Any, Listener]]:
    listener = Listener()
    number = MessageSchema(
        encoding="cdr",
        schema=foxglove.Schema(name="Number", encoding="ros2msg", data=NUMBER),
    )
    context = foxglove.Context()
    server = foxglove.start_server(
        name="another robot",
        port=0,
        context=context,
        server_listener=listener,
        capabilities=[
            Capability.ClientPublish,
            Capability.Parameters,
            Capability.Services,
        ],
        supported_encodings=["cdr", "json"],
        services=[
            Service(
                name="/double",
                schema=ServiceSchema(name="Number", request=number, response=number),
                handler=double,
            )
        ],
    )
    yield (server, context), listener
    server.stop()


def test_the_page_works_at_another_server(other: tuple[Any, Listener]) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    (server, context), listener = other
    kind = "nav_msgs/msg/OccupancyGrid"
    grid = OccupancyGrid(header=Header(frame_id="map"))
    grid.info.width, grid.info.height, grid.info.resolution = 8, 6, 0.5
    grid.data = np.zeros(48, np.int8)
    maps = foxglove.Channel(
        "/map",
        schema=foxglove.Schema(
            name=kind, encoding="ros2msg", data=definition_text(kind).encode()
        ),
        message_encoding="cdr",
        context=context,
    )
    battery = foxglove.Channel("/battery", schema=BATTERY, context=context)
    log = foxglove.channels.LogChannel("/log", context=context)  # protobuf

    def publish() -> None:
        maps.log(serialize(grid))
        battery.log({"charge": 0.7})
        log.log(foxglove.messages.Log(message="hello"))

    class Clock(Node):
        def __init__(self, context: Context) -> None:
            super().__init__("clock", context=context)
            self.create_timer(0.1, publish)

    with Program(Clock) as program:
        seen = run_node(
            "foreign.mjs",
            program.viewer.url,
            chromium,
            f"ws://127.0.0.1:{server.port}",
        )
    assert seen["problems"] == []
    assert seen["received"] == {"charge": 0.7}
    assert seen["answer"] == 42
    assert listener.parameters == {"speed": 2.5}
    [goal] = [deserialize(data, PoseStamped) for data in listener.published]
    assert (goal.pose.position.x, goal.pose.position.y) == (3.0, 4.0)
    [notice] = seen["notices"]
    assert "protobuf" in notice
