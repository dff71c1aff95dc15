"""One client of the live view, and what the view asks of the running program."""

from dataclasses import dataclass, field
from typing import Protocol

from navette.viewer import replies
from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.memory import STATE_TYPES
from navette.viewer.outbox import Outbox
from navette.viewer.replies import Channel, Level


@dataclass(frozen=True)
class Topic:
    """A topic of the graph with one type; ``latched`` is transient local."""

    name: str
    type_name: str
    definition: str
    latched: bool = False

    @property
    def is_kept(self) -> bool:
        """Whether newcomers are given the last message from here."""
        return not self.latched and self.type_name in STATE_TYPES


@dataclass(frozen=True)
class Watch:
    """A subscription that the program keeps for the viewer.

    Clients share one (``client`` None), except for latched topics: there each client
    has its own, so that the graph itself sends the latched messages to newcomers.
    """

    channel: Channel
    client: int | None


class Robot(Protocol):
    """What the hub asks of the running program; every call returns at once.

    After each publisher, publish, parameter and playback call the program calls
    :meth:`Hub.done`, so that a client cannot pile up work.
    """

    def watch(self, watch: Watch) -> None: ...
    def unwatch(self, watch: Watch) -> None: ...
    def open_publisher(self, client: int, channel: ClientChannel) -> None: ...
    def close_publisher(self, client: int, channel_id: int) -> None: ...
    def publish(self, client: int, channel_id: int, data: bytes) -> None: ...
    def get_parameters(
        self, client: int, names: tuple[str, ...], request_id: str | None
    ) -> None: ...
    def set_parameters(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None: ...
    def describe_parameters(self, client: int) -> None: ...
    def control_playback(self, client: int, request: ControlPlayback) -> None: ...
    def step_playback(self, client: int) -> None: ...


@dataclass
class Session:
    """One client: what it subscribes to, publishes and watches."""

    id: int
    outbox: Outbox
    channel_by_subscription: dict[int, int] = field(default_factory=dict)
    subscription_by_channel: dict[int, int] = field(default_factory=dict)
    client_channels: dict[int, ClientChannel] = field(default_factory=dict)
    parameter_names: set[str] = field(default_factory=set)
    all_parameters: bool = False
    wants_graph: bool = False
    wants_nodes: bool = False
    pending: int = 0

    def send(self, frame: str | bytes) -> None:
        self.outbox.put_control(frame)

    def complain(self, message: str, level: Level = Level.ERROR) -> None:
        self.send(replies.status(level, message))

    @property
    def is_curious(self) -> bool:
        """Whether it wants to know of what only the nodes themselves can tell."""
        return self.wants_nodes or self.all_parameters or bool(self.parameter_names)

    def wants_parameter(self, name: str) -> bool:
        return self.all_parameters or name in self.parameter_names
