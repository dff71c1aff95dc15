"""A fake of the running program, a hub with clients, and a decoder of sent frames."""

import json
from collections.abc import Callable, Hashable
from pathlib import Path
from typing import Any

from navette.viewer.assets import AssetFolders
from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.hub import Hub
from navette.viewer.outbox import Outbox
from navette.viewer.replies import Channel, OfferedService
from navette.viewer.session import CallId, Session, Watch


class FakeDocuments:
    """Documents of the site that name themselves."""

    def layout(self) -> dict[str, Any]:
        return {"layout": 1}

    def health(self) -> dict[str, Any]:
        return {"status": "ok"}


class RecordingProgram:
    """Records the commands of the hub."""

    def __init__(self) -> None:
        self.calls: list[tuple[Any, ...]] = []

    def watch(self, watch: Watch) -> None:
        self.calls.append(("watch", watch.channel.topic, watch.client))

    def unwatch(self, watch: Watch) -> None:
        self.calls.append(("unwatch", watch.channel.topic, watch.client))

    def open_publisher(self, client: int, channel: ClientChannel) -> None:
        self.calls.append(("open", client, channel))

    def close_publisher(self, client: int, channel_id: int) -> None:
        self.calls.append(("close", client, channel_id))

    def publish_from_client(self, client: int, channel_id: int, data: bytes) -> None:
        self.calls.append(("publish", client, channel_id, data))

    def request_parameters(
        self, client: int, names: tuple[str, ...], request_id: str | None
    ) -> None:
        self.calls.append(("get", client, names, request_id))

    def change_parameters(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None:
        self.calls.append(("set", client, parameters, request_id))

    def request_parameter_texts(self, client: int) -> None:
        self.calls.append(("describe", client))

    def call_service(
        self, call_id: CallId, service: OfferedService, encoding: str, data: bytes
    ) -> None:
        self.calls.append(("call", call_id, service.name, encoding, data))

    def control_playback(self, client: int, request: ControlPlayback) -> None:
        self.calls.append(("playback", client, request))

    def step_playback(self, client: int) -> None:
        self.calls.append(("step", client))

    def take(self) -> list[tuple[Any, ...]]:
        calls, self.calls = self.calls, []
        return calls


class DirectCommands:
    """Runs commands at once, in place of the queue to the executor's thread."""

    def add(
        self,
        _lane: Hashable,
        command: Callable[[], None],
        _key: Hashable | None = None,
        *,
        is_next: bool = False,
    ) -> None:
        command()


class Bench:
    """A hub with a recording program and clients that send JSON."""

    def __init__(self, folder: Path) -> None:
        self.program = RecordingProgram()
        self.hub = Hub(
            self.program,
            DirectCommands(),
            name="test",
            session_id="1",
            assets=AssetFolders({"navette": folder}),
        )

    def join(self) -> Session:
        session = self.hub.join(Outbox())
        sent(session.outbox)
        return session

    def ask(self, session: Session, **document: Any) -> list[Any]:
        """Send one JSON frame; gives what is sent back."""
        self.hub.receive(session, json.dumps(document))
        return sent(session.outbox)

    def subscribe(self, session: Session, subscription: int, channel: int) -> list[Any]:
        pair = {"id": subscription, "channelId": channel}
        return self.ask(session, op="subscribe", subscriptions=[pair])

    def advertise(self, session: Session, **fields: Any) -> list[Any]:
        channel = {
            "id": 1,
            "topic": "/goal_point",
            "encoding": "json",
            "schemaName": "geometry_msgs/msg/PointStamped",
            **fields,
        }
        return self.ask(session, op="advertise", channels=[channel])

    def stream(self, channel: Channel) -> None:
        """Publish as often as a stream for two periods."""
        for _ in range(2):
            for stamp_ns in range(1, 6):
                self.hub.subscriptions.message(Watch(channel, None), stamp_ns, b"old")
            self.hub.subscriptions.end_period()

    def channel(self, topic: str) -> Channel:
        return next(c for c in self.hub.subscriptions.channels if c.topic == topic)


class FakeBridge:
    """Calls the hub at once; keeps what is scheduled until the test runs it."""

    def __init__(self) -> None:
        self.soon: list[Callable[[], object]] = []
        self.later: list[tuple[float, Callable[[], None]]] = []

    def call_hub(self, method: Callable[..., None], *args: Any) -> None:
        method(*args)

    def call_later(self, delay_s: float, function: Callable[[], None]) -> None:
        self.later.append((delay_s, function))

    def run_soon(self, function: Callable[[], object], _source: str) -> None:
        self.soon.append(function)


class FakeClock:
    """Wall time and CPU time that advance on request, and in a sleep."""

    def __init__(self) -> None:
        self.now_s = self.thread_cpu_s = self.slept_s = 0.0

    def work(self, duration_s: float) -> None:
        self.now_s += duration_s
        self.thread_cpu_s += duration_s

    def wait(self, duration_s: float) -> None:
        """Advance the wall time only, as while other threads run."""
        self.now_s += duration_s

    def sleep(self, duration_s: float) -> None:
        self.now_s += duration_s
        self.slept_s += duration_s


def sent(outbox: Outbox) -> list[Any]:
    """Return all queued frames: JSON frames as objects, binary frames as bytes."""
    frames: list[Any] = []
    while outbox:
        frame = outbox.pop()
        frames.append(json.loads(frame) if isinstance(frame, str) else frame)
    return frames
