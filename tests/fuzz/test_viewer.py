"""Frames of hostile clients: no frame ends the program or affects other clients.

Every operation with fields of the wrong type, extreme values and damaged bytes;
messages of many types on many topics, as JSON and CDR; requests that are not HTTP.
"""

import json
import random  # noqa: TID251 - draws Python values; seeded
import socket
import struct
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from fuzz.limits import rounds
from navette.msgs import get_interface, serialize
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Node

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import (
    Client,
    NonReadingClient,
    Program,
    raw_frame,
)

pytestmark = pytest.mark.long

_FRAMES = 3000
_CONNECTIONS = 150
_BATCHES, _BATCH = 10, 30  # of one client
TEXT, BINARY = 1, 2

_STRINGS = (
    "", "/", "/chatter", "/talker.depth", "/talker.", ".depth", "cdr", "json", "~/x",
    "std_msgs/msg/String", "\0", "\ud800", "地図", "a" * 999, "a" * 1001, "/a//b",
    "a/msg/B", "package://navette/", "package://navette/\ud800", "package://[", "NaN",
    "float64", "float64_array", "byte_array", "/parameter_events", "/tf", "\x1b[2J",
)  # fmt: skip
_NUMBERS = (
    0, 1, 2, -1, 255, 256, 2**31, 2**32 - 1, 2**32, 2**63, 2**64, 10**400, 0.5, 1e308,
    -0.0, float("inf"), float("nan"),
)  # fmt: skip
#: Fields of each operation with a valid value of each.
_OPERATIONS: dict[str, dict[str, Any]] = {
    "subscribe": {"subscriptions": [{"id": 1, "channelId": 1}]},
    "unsubscribe": {"subscriptionIds": [1]},
    "advertise": {
        "channels": [
            {
                "id": 1,
                "topic": "/a",
                "encoding": "json",
                "schemaName": "std_msgs/String",
            }
        ]
    },
    "unadvertise": {"channelIds": [1]},
    "getParameters": {"parameterNames": ["/talker.depth"], "id": "a"},
    "setParameters": {
        "parameters": [{"name": "/talker.depth", "value": 1, "type": "float64"}],
        "id": "a",
    },
    "subscribeParameterUpdates": {"parameterNames": ["/talker.depth"]},
    "unsubscribeParameterUpdates": {"parameterNames": ["/talker.depth"]},
    "subscribeConnectionGraph": {},
    "unsubscribeConnectionGraph": {},
    "subscribeNodes": {},
    "unsubscribeNodes": {},
    "stepPlayback": {},
    "fetchAsset": {"uri": "package://navette/a", "requestId": 1},
    "none": {},
}
_TYPES = (
    "std_msgs/msg/String", "std_msgs/msg/Header", "geometry_msgs/msg/Twist",
    "geometry_msgs/msg/PointStamped", "nav_msgs/msg/Path", "nav_msgs/msg/OccupancyGrid",
    "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/Imu", "tf2_msgs/msg/TFMessage",
    "rcl_interfaces/msg/ParameterEvent", "rcl_interfaces/msg/Log",
    "visualization_msgs/msg/MarkerArray", "std_msgs/msg/Float64MultiArray",
)  # fmt: skip


class Frames:
    """Draws frames; the same seed draws the same ones."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def frame(self) -> bytes:
        """Return one frame, at times with damaged bytes."""
        draw = self.random.randrange(10)
        if draw < 5:
            # Bytes that are not UTF-8 end the connection before they are decoded.
            text = self._damaged(self.text()).decode(errors="ignore")
            return raw_frame(TEXT, text.encode())
        if draw < 7:
            return raw_frame(BINARY, self._damaged(self.publication()))
        if draw < 9:
            return raw_frame(BINARY, self._damaged(self.binary()))
        return raw_frame(BINARY, self._bytes(200))

    def text(self) -> bytes:
        operation = self.random.choice(tuple(_OPERATIONS))
        document = self.confused(_OPERATIONS[operation])
        if isinstance(document, dict) and self.random.random() < 0.95:
            document = {"op": operation, **document}
        return json.dumps(document).encode()

    def confused(self, value: Any) -> Any:
        """Return a value in which each part may be of another type."""
        if self.random.random() < 0.12:
            return self.anything(3)
        if isinstance(value, dict):
            return {
                name: self.confused(item)
                for name, item in value.items()
                if self.random.random() < 0.95
            }
        if isinstance(value, list):
            count = self.random.choice((0, 1, 2, 5, 40))
            return [self.confused(value[0]) for _ in range(count)]
        if isinstance(value, str) and self.random.random() < 0.6:
            return self.random.choice(_STRINGS)
        if isinstance(value, int) and self.random.random() < 0.6:
            return self.random.randrange(1, 30)
        return value

    def anything(self, depth: int) -> Any:
        kind = self.random.randrange(7 if depth else 5)
        if kind < 2:
            return self.random.choice(_NUMBERS)
        if kind < 4:
            return self.random.choice(_STRINGS)
        if kind == 4:
            return self.random.choice((None, True, False))
        parts = [self.anything(depth - 1) for _ in range(self.random.randrange(4))]
        if kind == 5:
            return parts
        return {self.random.choice(_STRINGS): part for part in parts}

    def channels(self) -> bytes:
        """Return a valid request to open channels for many types and topics."""
        topics = (
            "/a",
            "/chatter",
            "/parameter_events",
            "/rosout",
            "/tf",
            "/goal_point",
        )
        channels = [
            {
                "id": number,
                "topic": self.random.choice(topics),
                "encoding": self.random.choice(("cdr", "json")),
                "schemaName": self.random.choice(_TYPES),
            }
            for number in range(20)
        ]
        document = {"op": "advertise", "channels": channels}
        return raw_frame(TEXT, json.dumps(document).encode())

    def publication(self) -> bytes:
        cls = get_interface(self.random.choice(_TYPES))
        names = list(cls.get_fields_and_field_types())
        if self.random.random() < 0.5:
            data = self._damaged(serialize(cls()))
        elif self.random.random() < 0.1:
            deep = self.random.choice((20, 40, 900))
            data = b'{"data": ' + b"[" * deep + b"]" * deep + b"}"
        else:
            document = {name: self.anything(4) for name in names}
            data = json.dumps(document).encode()
        return struct.pack("<BI", 1, self.random.randrange(25)) + data

    def binary(self) -> bytes:
        number = self.random.choice([n for n in _NUMBERS if isinstance(n, int)])
        word = abs(number) % 2**32
        if self.random.random() < 0.5:
            return struct.pack("<BIII", 2, word, 1, word % 7) + b"json{}"
        speed = float(self.random.choice((0.0, 1.0, float("nan"), float("inf"), -1.0)))
        long = abs(number) % 2**64
        head = struct.pack("<BBfBQI", 3, word % 3, speed, word % 2, long, word % 9)
        return head + b"abcdefghi"

    def request(self) -> bytes:
        """Return an HTTP request, or what is none."""
        if self.random.random() < 0.3:
            return self._bytes(3000)
        pick = self.random.choice
        head = (
            f"{pick(('GET', 'HEAD', 'POST', 'get', ''))} "
            f"{pick(('/', '*', '/?token=' + 'a' * 5000, '//[', '/../x'))} "
            f"HTTP/{pick(('1.1', '1.0', '2', ''))}\r\n"
            f"Host: {pick(('localhost', '[', '', '127.0.0.1', '::1'))}\r\n"
            f"Origin: {pick(('null', 'http://[', 'file://'))}\r\n"
            f"Authorization: {pick(('Bearer', 'Bearer x', '', 'x'))}\r\n"
            f"Upgrade: {pick(('websocket', 'h2c', ''))}\r\n\r\n"
        )
        return self._damaged(head.encode())

    def _damaged(self, data: bytes) -> bytes:
        if self.random.random() < 0.75 or not data:
            return data
        damaged = bytearray(data)
        for _ in range(self.random.randrange(1, 4)):
            damaged[self.random.randrange(len(damaged))] = self.random.randrange(256)
        return bytes(damaged[: self.random.randrange(1, len(damaged) + 1)])

    def _bytes(self, most: int) -> bytes:
        return self.random.randbytes(self.random.randrange(most))


class Talker(Node):
    """Publishes; its parameters have every kind of value."""

    def __init__(self, context: Context) -> None:
        super().__init__("talker", context=context)
        values = (3, 1.5, True, "text", [1, 2], [0.5], ["a"], [True], [b"x"])
        for number, value in enumerate(values):
            self.declare_parameter("depth" if not number else f"p{number}", value)
        publisher = self.create_publisher(String, "/chatter", 10)
        self.create_timer(0.05, lambda: publisher.publish(String(data="hello")))


@pytest.fixture
def program(caplog: pytest.LogCaptureFixture, tmp_path: Path) -> Iterator[Program]:
    """A program whose callbacks and connections must not raise."""
    with Program(Talker, asset_folders={"navette": tmp_path}) as running:
        yield running
    failed = [r for r in caplog.records if r.exc_info or r.name.endswith("asyncio")]
    assert not failed, [record.getMessage() for record in failed]


def check(program: Program) -> None:
    """A new client is served; otherwise the program failed."""
    assert program.failure is None
    with Client(program.address) as client:
        client.subscribe("/chatter", 1)
        assert client.message(1)[1]
        assert client.get_parameters("/talker.p3") != {}


def test_frames(program: Program) -> None:
    handled = count_frames(program)
    for seed in rounds():
        frames, handled[0] = Frames(seed), 0
        sent = 0
        while sent < _FRAMES:
            with NonReadingClient(program.address) as client:
                client.send_raw(frames.channels())
                for _ in range(_BATCHES):
                    for _ in range(_BATCH):
                        client.send_raw(frames.frame())
                    sent += _BATCH
                    wait_until_handled(client)
            check(program)
        assert handled[0] >= sent


def count_frames(program: Program) -> list[int]:
    """Count the frames that the program handles, in the list's only element."""
    hub, count = program.viewer._hub, [0]
    receive = hub.receive

    def counted(*args: Any) -> None:
        count[0] += 1
        receive(*args)

    hub.receive = counted  # type: ignore[method-assign]
    return count


def wait_until_handled(client: NonReadingClient) -> None:
    """Wait for the response to a request behind all others."""
    client.send(op="getParameters", parameterNames=["/talker.depth"], id="barrier")
    client.read_until(b'"id":"barrier"')


def test_requests(program: Program) -> None:
    for seed in rounds():
        frames = Frames(seed)
        address = ("127.0.0.1", program.viewer.port)
        for _ in range(_CONNECTIONS):
            with socket.create_connection(address) as client, suppress(OSError):
                client.sendall(frames.request())
                client.shutdown(socket.SHUT_WR)
                while client.recv(1 << 16):
                    pass
        check(program)
