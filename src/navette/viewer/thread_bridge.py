"""From the socket thread to the executor's thread: commands become events of a node."""

from collections.abc import Callable
from functools import partial
from typing import Any

from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.session import ProgramCommands, Watch

RunSoon = Callable[[Callable[[], None], str], None]
"""Schedules a function on the executor's thread, with a name for it in errors."""


class ThreadBridge:
    """Forwards each command to ``target`` on the executor's thread; returns at once."""

    def __init__(self, target: ProgramCommands, run_soon: RunSoon) -> None:
        self._target = target
        self._run_soon = run_soon

    def watch(self, watch: Watch) -> None:
        self._forward(self._target.watch, watch)

    def unwatch(self, watch: Watch) -> None:
        self._forward(self._target.unwatch, watch)

    def open_publisher(self, client: int, channel: ClientChannel) -> None:
        self._forward(self._target.open_publisher, client, channel)

    def close_publisher(self, client: int, channel_id: int) -> None:
        self._forward(self._target.close_publisher, client, channel_id)

    def publish_from_client(self, client: int, channel_id: int, data: bytes) -> None:
        self._forward(self._target.publish_from_client, client, channel_id, data)

    def request_parameters(
        self, client: int, names: tuple[str, ...], request_id: str | None
    ) -> None:
        self._forward(self._target.request_parameters, client, names, request_id)

    def change_parameters(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None:
        self._forward(self._target.change_parameters, client, parameters, request_id)

    def request_parameter_texts(self, client: int) -> None:
        self._forward(self._target.request_parameter_texts, client)

    def control_playback(self, client: int, request: ControlPlayback) -> None:
        self._forward(self._target.control_playback, client, request)

    def step_playback(self, client: int) -> None:
        self._forward(self._target.step_playback, client)

    def _forward(self, command: Callable[..., None], *args: Any) -> None:
        self._run_soon(partial(command, *args), command.__name__)
