"""A fake of the running program, and a decoder of sent frames."""

import json
from collections.abc import Callable, Hashable
from typing import Any

from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.outbox import Outbox
from navette.viewer.replies import OfferedService
from navette.viewer.session import CallId, Watch


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
