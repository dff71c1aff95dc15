"""Between the threads: what clients want becomes events of a node."""

from collections.abc import Callable
from functools import partial
from typing import Protocol

from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.parameter_desk import ParameterDesk
from navette.viewer.playback_desk import PlaybackDesk
from navette.viewer.publishing import ClientPublishers
from navette.viewer.session import Watch


class FarEnd(Protocol):
    """The node; all but ``run_soon`` belongs to the executor's thread."""

    client_publishers: ClientPublishers
    desk: ParameterDesk
    playback: PlaybackDesk

    def run_soon(self, function: Callable[[], None], source: str) -> None:
        """Run it on the executor's thread, as an event of the node."""

    def answer(self, client: int, work: Callable[[], None]) -> None:
        """Do a client's request; what is wrong with it is told to that client."""

    def watch(self, watch: Watch) -> None: ...
    def unwatch(self, watch: Watch) -> None: ...


class Bridge:
    """The hub's :class:`~navette.viewer.session.Robot`; returns at once.

    The far end's desks are looked up when something is wanted: they are made with the
    hub, and the hub with this.
    """

    def __init__(self, end: FarEnd) -> None:
        self._end = end

    def watch(self, watch: Watch) -> None:
        self._end.run_soon(partial(self._end.watch, watch), "watch")

    def unwatch(self, watch: Watch) -> None:
        self._end.run_soon(partial(self._end.unwatch, watch), "unwatch")

    def open_publisher(self, client: int, channel: ClientChannel) -> None:
        self._ask(client, partial(self._end.client_publishers.open, client, channel))

    def close_publisher(self, client: int, channel_id: int) -> None:
        self._ask(
            client, partial(self._end.client_publishers.close, client, channel_id)
        )

    def publish(self, client: int, channel_id: int, data: bytes) -> None:
        work = partial(self._end.client_publishers.publish, client, channel_id, data)
        self._ask(client, work)

    def get_parameters(
        self, client: int, names: tuple[str, ...], request_id: str | None
    ) -> None:
        ask = partial(self._end.desk.get, client, names, request_id)
        self._end.run_soon(ask, "request")

    def set_parameters(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None:
        ask = partial(self._end.desk.set, client, parameters, request_id)
        self._end.run_soon(ask, "request")

    def describe_parameters(self, client: int) -> None:
        self._end.run_soon(partial(self._end.desk.describe, client), "request")

    def control_playback(self, client: int, request: ControlPlayback) -> None:
        self._ask(client, partial(self._end.playback.control, request))

    def step_playback(self, client: int) -> None:
        self._ask(client, self._end.playback.step)

    def _ask(self, client: int, work: Callable[[], None]) -> None:
        self._end.run_soon(partial(self._end.answer, client, work), "request")
