"""A stand-in for the running program and a reader of sent frames."""

import json
from typing import Any

from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.outbox import Outbox
from navette.viewer.session import Watch


class RecordingRobot:
    """Notes what the hub asks of the program."""

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

    def publish(self, client: int, channel_id: int, data: bytes) -> None:
        self.calls.append(("publish", client, channel_id, data))

    def get_parameters(
        self, client: int, names: tuple[str, ...], request_id: str | None
    ) -> None:
        self.calls.append(("get", client, names, request_id))

    def set_parameters(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None:
        self.calls.append(("set", client, parameters, request_id))

    def describe_parameters(self, client: int) -> None:
        self.calls.append(("describe", client))

    def control_playback(self, client: int, request: ControlPlayback) -> None:
        self.calls.append(("playback", client, request))

    def step_playback(self, client: int) -> None:
        self.calls.append(("step", client))

    def take(self) -> list[tuple[Any, ...]]:
        calls, self.calls = self.calls, []
        return calls


def sent(outbox: Outbox) -> list[Any]:
    """All frames that wait: JSON ones as objects, binary ones as bytes."""
    frames: list[Any] = []
    while outbox:
        frame = outbox.pop()
        frames.append(json.loads(frame) if isinstance(frame, str) else frame)
    return frames
