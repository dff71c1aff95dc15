"""One client of the live view, and the commands that the view sends to the program."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol

from navette.viewer import replies
from navette.viewer.command_queue import CommandRunner
from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.grid_copies import GridCopies
from navette.viewer.last_value_cache import STATE_TYPES
from navette.viewer.outbox import MessageFrame, Outbox
from navette.viewer.replies import Channel, Level, OfferedService

_MAX_PROBLEMS = 3  # of a request that are reported one by one


@dataclass(frozen=True)
class Topic:
    """A topic of the graph with one type; ``latched`` means transient local."""

    name: str
    type_name: str
    definition: str
    latched: bool = False

    @property
    def is_kept(self) -> bool:
        """Whether the view itself stores the last message for new clients."""
        return not self.latched and self.type_name in STATE_TYPES


@dataclass(frozen=True)
class Watch:
    """A subscription that the program keeps for the live view.

    Clients share one subscription (``client`` None), except for latched topics: there
    each client has its own, so that the graph delivers the latched messages to it.
    """

    channel: Channel
    client: int | None


@dataclass(frozen=True)
class CallId:
    """A client's call of a service; ``number`` is chosen by the client."""

    client: int
    service_id: int
    number: int


class ProgramCommands(Protocol):
    """Commands of the hub to the running program.

    :class:`~navette.viewer.node.ViewerNode` executes them on the executor's thread.
    After each publisher, publish, parameter and playback command the program calls
    :meth:`Hub.done`; the number of unfinished commands of a client is limited. A
    service call ends with :meth:`OfferedServices.responded` or
    :meth:`OfferedServices.failed`.
    """

    def watch(self, watch: Watch) -> None: ...
    def unwatch(self, watch: Watch) -> None: ...
    def open_publisher(self, client: int, channel: ClientChannel) -> None: ...
    def close_publisher(self, client: int, channel_id: int) -> None: ...
    def publish_from_client(
        self, client: int, channel_id: int, data: bytes
    ) -> None: ...
    def request_parameters(
        self, client: int, names: tuple[str, ...], request_id: str | None
    ) -> None: ...
    def change_parameters(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None: ...
    def request_parameter_texts(self, client: int) -> None: ...
    def call_service(
        self, call_id: CallId, service: OfferedService, encoding: str, data: bytes
    ) -> None: ...
    def control_playback(self, client: int, request: ControlPlayback) -> None: ...
    def step_playback(self, client: int) -> None: ...


@dataclass
class Session:
    """State of one client: subscriptions, published channels, requested reports."""

    id: int
    outbox: Outbox
    commands: CommandRunner
    channel_by_subscription: dict[int, int] = field(default_factory=dict)
    subscription_by_channel: dict[int, int] = field(default_factory=dict)
    client_channels: dict[int, ClientChannel] = field(default_factory=dict)
    parameter_names: set[str] = field(default_factory=set)
    all_parameters: bool = False
    wants_graph: bool = False
    wants_nodes: bool = False
    is_suspended: bool = False
    """The client does not read: its subscriptions to streams deliver nothing."""
    suspended_channels: set[int] = field(default_factory=set)
    pending: int = 0
    calls: set[CallId] = field(default_factory=set)  # of services, without a response
    grid_copies: GridCopies | None = None
    """of a client that applies updates to grids"""

    def put(self, channel: Channel, frame: MessageFrame) -> None:
        """Queue a message of a subscription."""
        if self.grid_copies is None:
            self.outbox.put_data(frame.subscription_id, frame)
        else:
            self.grid_copies.put(channel, frame)

    def send(self, frame: str | bytes) -> None:
        self.outbox.put_control(frame)

    def send_status(self, message: str, level: Level = Level.ERROR) -> None:
        self.send(replies.status(level, message))

    def send_problems(
        self, operation: str, problems: list[str], level: Level = Level.ERROR
    ) -> None:
        """Send the problems of a request, a bounded number of them one by one."""
        for problem in problems[:_MAX_PROBLEMS]:
            self.send_status(f"{operation}: {problem}", level)
        more = len(problems) - _MAX_PROBLEMS
        if more > 0:
            self.send_status(f"{operation}: {more} more entries are refused", level)

    def add_command(self, command: Callable[..., None], *args: Any) -> None:
        """Queue a command to the program, which is pending until :meth:`Hub.done`."""
        self.pending += 1
        self.commands.add(self.id, partial(command, self.id, *args))

    @property
    def wants_node_reports(self) -> bool:
        return self.wants_nodes or self.all_parameters or bool(self.parameter_names)

    def wants_parameter(self, name: str) -> bool:
        return self.all_parameters or name in self.parameter_names
