"""A running program with a live view, and an independent protocol client."""

import json
import socket
import struct
import threading
from collections.abc import Callable, Mapping
from contextlib import ExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from navette.runtime import Context, Executor, Node, Parameter, SystemClock
from navette.viewer.node import ViewerNode
from navette.viewer.playback import Playback

PATIENCE_S = 60.0  # only a broken test waits this long


class Program:
    """Nodes and a viewer on a free port, spun by a thread."""

    def __init__(
        self,
        *make_nodes: Callable[[Context], Node],
        asset_folders: Mapping[str, Path] | None = None,
        playback: Playback | None = None,
        transport: str | None = None,
        **params: Any,
    ) -> None:
        self.context = Context(clock=SystemClock(), transport=transport)
        self.executor = Executor(context=self.context)
        self.nodes = [make(self.context) for make in make_nodes]
        overrides = [Parameter(k, value=v) for k, v in {"port": 0, **params}.items()]
        self.viewer = ViewerNode(
            context=self.context,
            asset_folders=asset_folders,
            playback=playback,
            parameter_overrides=overrides,
        )
        for node in (*self.nodes, self.viewer):
            self.executor.add_node(node)
        self.failure: BaseException | None = None
        self._thread = threading.Thread(target=self._spin)
        self._thread.start()

    @property
    def address(self) -> str:
        return f"127.0.0.1:{self.viewer.port}"

    def do(self, work: Callable[[], Any]) -> Any:
        """Run ``work`` on the executor's thread; gives its result."""
        done = threading.Event()
        results: list[Any] = []

        def event() -> None:
            results.append(work())
            done.set()

        self.executor.call_soon_threadsafe(event)
        assert done.wait(PATIENCE_S), "the executor does not run"
        return results[0]

    def stop(self) -> None:
        """Stop callbacks; the viewer's own thread keeps running."""
        self.executor.stop()
        self._thread.join()

    def close(self) -> None:
        self.stop()
        self.viewer.close()
        self.context.try_shutdown()
        if self.failure is not None:
            raise self.failure

    def __enter__(self) -> "Program":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _spin(self) -> None:
        try:
            self.executor.spin()
        except Exception as error:
            self.failure = error


class Client:
    """Implements the published protocol without the viewer's own code."""

    def __init__(
        self, address: str, subprotocol: str = "foxglove.websocket.v1", **options: Any
    ) -> None:
        self._stack = ExitStack()
        self.socket: ClientConnection = self._stack.enter_context(
            connect(
                f"{'wss' if 'ssl' in options else 'ws'}://{address}",
                subprotocols=[Subprotocol(subprotocol)],
                open_timeout=PATIENCE_S,
                # Of a client that vanishes the thread stays, and its pings would draw
                # from the random numbers that Hypothesis watches in a later test.
                ping_interval=None,
                max_size=None,
                **options,
            )
        )
        self.channels: dict[str, dict[str, Any]] = {}
        self.statuses: list[dict[str, Any]] = []
        self.info = self.wait_for(lambda frame: _is(frame, "serverInfo"))

    def send(self, **document: Any) -> None:
        self.socket.send(json.dumps(document))

    def receive(self) -> Any:
        """The next frame: a dict, or for binary ones (opcode, id, stamp, payload)."""
        frame = self.socket.recv(timeout=PATIENCE_S)
        if isinstance(frame, bytes):
            return _split(frame)
        document = json.loads(frame)
        if document["op"] == "advertise":
            self.channels |= {c["topic"]: c for c in document["channels"]}
        elif document["op"] == "unadvertise":
            gone = document["channelIds"]
            kept = {t: c for t, c in self.channels.items() if c["id"] not in gone}
            self.channels = kept
        elif document["op"] == "status":
            self.statuses.append(document)
        return document

    def wait_for(self, wanted: Callable[[Any], bool]) -> Any:
        while True:
            frame = self.receive()
            if wanted(frame):
                return frame

    def wait_for_op(self, op: str) -> dict[str, Any]:
        document: dict[str, Any] = self.wait_for(lambda frame: _is(frame, op))
        return document

    def wait_for_topic(self, topic: str) -> dict[str, Any]:
        while topic not in self.channels:
            self.receive()
        return self.channels[topic]

    def subscribe(self, topic: str, subscription: int) -> dict[str, Any]:
        channel = self.wait_for_topic(topic)
        pair = {"id": subscription, "channelId": channel["id"]}
        self.send(op="subscribe", subscriptions=[pair])
        return channel

    def message(self, subscription: int) -> tuple[int, bytes]:
        """The next message of a subscription: stamp (ns) and payload."""
        frame = self.wait_for(
            lambda f: isinstance(f, tuple) and f[:2] == (1, subscription)
        )
        return frame[2], frame[3]

    def advertise(
        self, channel: int, topic: str, encoding: str, schema_name: str
    ) -> None:
        entry = {
            "id": channel,
            "topic": topic,
            "encoding": encoding,
            "schemaName": schema_name,
        }
        self.send(op="advertise", channels=[entry])

    def publish(self, channel: int, data: bytes) -> None:
        self.socket.send(struct.pack("<BI", 1, channel) + data)

    def get_parameters(self, *names: str) -> dict[str, Any]:
        """Values by name; a round trip through the executor."""
        self.send(op="getParameters", parameterNames=list(names), id="harness")
        values = self.wait_for_op("parameterValues")
        return {p["name"]: p.get("value") for p in values["parameters"]}

    def read_to_the_end(self) -> None:
        """Until the server ends the connection."""
        with suppress(ConnectionClosed):
            while True:
                self.receive()

    def close(self) -> None:
        self._stack.close()

    def __enter__(self) -> "Client":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def raw_frame(opcode: int, data: bytes, *, fin: bool = True) -> bytes:
    """A masked frame (RFC 6455, 5.2); a mask of zeros changes nothing."""
    first = opcode | (0x80 if fin else 0)
    return struct.pack(">BBH4x", first, 0x80 | 126, len(data)) + data


class NonReadingClient:
    """Opens the socket and sends any bytes, but never reads on its own."""

    def __init__(self, address: str) -> None:
        host, _, port = address.partition(":")
        self._socket = socket.create_connection((host, int(port)))
        request = [
            "GET / HTTP/1.1",
            f"Host: {address}",
            "Upgrade: websocket",
            "Connection: Upgrade",
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Protocol: foxglove.sdk.v1",
        ]
        self._socket.sendall(("\r\n".join(request) + "\r\n\r\n").encode())
        assert self._socket.recv(12) == b"HTTP/1.1 101"

    def send(self, **document: Any) -> None:
        self.send_raw(raw_frame(1, json.dumps(document).encode()))

    def send_raw(self, data: bytes) -> None:
        self._socket.sendall(data)

    def read_until(self, wanted: bytes) -> None:
        """Read until ``wanted`` was received."""
        received = b""
        self._socket.settimeout(PATIENCE_S)
        while wanted not in received:
            data = self._socket.recv(1 << 16)
            assert data, f"closed after {received[-200:]!r}"
            received = received[-len(wanted) :] + data

    def read_to_the_end(self) -> bytes:
        """Return all bytes until the server ends the connection."""
        received = b""
        self._socket.settimeout(PATIENCE_S)
        with suppress(ConnectionError):
            while data := self._socket.recv(1 << 16):
                received += data
        return received

    def close(self) -> None:
        self._socket.close()

    def __enter__(self) -> "NonReadingClient":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _is(frame: Any, op: str) -> bool:
    return isinstance(frame, dict) and frame["op"] == op


def _split(frame: bytes) -> tuple[Any, ...]:
    if frame[0] == 1:
        subscription, stamp = struct.unpack_from("<IQ", frame, 1)
        return 1, subscription, stamp, frame[13:]
    if frame[0] == 2:
        return (2, *struct.unpack_from("<Q", frame, 1))
    if frame[0] == 3:
        service, call, length = struct.unpack_from("<III", frame, 1)
        return 3, service, call, frame[13 : 13 + length].decode(), frame[13 + length :]
    if frame[0] == 5:
        return 5, frame[1:]
    assert frame[0] == 4, f"unknown opcode {frame[0]}"
    request, status, length = struct.unpack_from("<IBI", frame, 1)
    return 4, request, status, frame[10 : 10 + length], frame[10 + length :]
