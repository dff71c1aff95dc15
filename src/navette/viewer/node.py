"""The node ``viewer``: every topic of its context for the Foxglove app and browsers.

Two threads meet here. Node methods run on the executor's thread: the hub's commands
(socket thread) become events of the executor, and data for clients passes through the
server's queue. Neither thread waits for the other.

Topics appear as the graph changes. A topic without a watching client is not subscribed,
except for those whose last message is cached (:mod:`navette.viewer.last_value_cache`).
Parameters and liveness of nodes of other processes are requested only while a client
displays them.
"""

import importlib.resources
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from navette import __version__
from navette.errors import (
    MessageError,
    NavetteError,
    ParameterError,
    UnknownNameError,
)
from navette.msgs import definition_text, get_interface, serialize
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.rcl_interfaces.msg import ParameterEvent, SetParametersResult
from navette.msgs.sensor_msgs.msg import CompressedImage, Image
from navette.params import Params
from navette.runtime.clock import SteadyClock
from navette.runtime.context import Context
from navette.runtime.parameter import Parameter
from navette.runtime.qos import (
    qos_profile_best_available,
    qos_profile_parameter_events,
)
from navette.runtime.stage.stage_node import StageNode
from navette.runtime.subscription import Subscription
from navette.viewer.access import Access
from navette.viewer.assets import AssetFolders
from navette.viewer.command_queue import CommandQueue
from navette.viewer.compressed_images import (
    COMPRESSED,
    SUFFIX,
    ImageCompressor,
    compressed_ends,
)
from navette.viewer.frames import ClientChannel, ControlPlayback, WireParameter
from navette.viewer.gate import Gate
from navette.viewer.graph_access import LocalNode
from navette.viewer.hub import Hub
from navette.viewer.large_grid import Payload, payload_of
from navette.viewer.layout import build_layout
from navette.viewer.listening import Listeners, listen
from navette.viewer.node_monitor import NodeMonitor
from navette.viewer.page_files import read_page
from navette.viewer.parameter_requests import ParameterRequests
from navette.viewer.params import ViewerParams
from navette.viewer.playback import Playback
from navette.viewer.playback_requests import PlaybackRequests
from navette.viewer.publishing import ClientPublishers
from navette.viewer.remote_parameters import LIST, RemoteParameters
from navette.viewer.replies import OfferedService
from navette.viewer.server import ViewerServer
from navette.viewer.service_calls import ServiceCalls
from navette.viewer.service_requests import ServiceRequests
from navette.viewer.session import CallId, Watch
from navette.viewer.topic_ends import TopicEnd, graph_of, is_hidden, topics_of
from navette.viewer.web import AccessPolicy, Site

_GRAPH = "graph"  # lane of the refreshes
_REFRESH_S = 0.1  # least wall time between two
# Packages of the services that every node has.
_EVERY_NODE = ("rcl_interfaces", "type_description_interfaces")


class ViewerNode(StageNode):
    """The live view; serves clients from construction until :meth:`close`.

    Args:
        playback: a recording that is played here: clients see its time and control it.
        asset_folders: folder of each package name in ``package://<name>/…`` URIs.
        listeners: sockets that listen already, instead of the parameters host and port.

    Raises:
        InvalidValueError: the port is in use or the address cannot be bound.
    """

    PARAMS: ClassVar[type[Params]] = ViewerParams
    params: ViewerParams

    def __init__(
        self,
        *,
        context: Context | None = None,
        playback: Playback | None = None,
        asset_folders: Mapping[str, Path] | None = None,
        parameter_overrides: Sequence[Parameter[Any]] | None = None,
        listeners: Listeners | None = None,
        cli_args: Sequence[str] | None = None,
    ) -> None:
        super().__init__(
            "viewer",
            context=context,
            parameter_overrides=parameter_overrides,
            cli_args=cli_args,
        )
        self._watched: dict[Watch, Subscription[Any]] = {}
        self._refreshing = False
        self._refreshed_s = -_REFRESH_S
        self._compressed: set[str] = set()  # topics that are made here
        self._definitions: dict[str, str | None] = {}
        self._stop_listening: Callable[[], None] = _nothing
        self._frames = ("map", "base_link")
        self._wall = SteadyClock()
        self._images = ImageCompressor(
            self.params.image_rate_hz, clock=self._wall, problems=self
        )
        self._commands = CommandQueue(bridge=self, clock=self._wall)
        self._hub = Hub(
            self,
            self._commands,
            name="Navette",
            # The same when a client reconnects, different in the next run.
            session_id=f"navette-{id(self):x}",
            assets=AssetFolders(asset_folders or {}),
            playback_range=None if playback is None else _range(playback),
        )
        self._publishers = ClientPublishers(graph=self)
        self._playback = PlaybackRequests(playback, self._hub, bridge=self)
        self._denial_noted = False
        try:
            self._access = Access.of(self.params, os.environ, self._wall)
            self._parameters = self._monitor_nodes()
            self._server = self._make_server(listeners)
            self._server.start()
        except BaseException:
            super().destroy_node()
            raise
        self.add_on_set_parameters_callback(_refuse_changes)
        self.create_subscription(
            ParameterEvent,
            "/parameter_events",
            self._parameters.on_event,
            qos_profile_parameter_events,
            shared=True,
        )
        self._stop_listening = self.context.graph.on_change(self._on_graph_change)
        self._refresh()
        self._playback.begin()

    @property
    def port(self) -> int:
        return self._server.port

    @property
    def url(self) -> str:
        """Address of the page; with ``ws://``, the address for the Foxglove app."""
        return self._access.url(self.params.host, self.port)

    @property
    def remote_url(self) -> str:
        """Address of the page for other machines, with the token; empty without any."""
        if not self._access.is_remote:
            return ""
        return self._access.remote_url(self.params.host, self.port)

    @property
    def client_count(self) -> int:
        return self._hub.clients

    def close(self) -> None:
        """Disconnect all clients and leave the graph; a second call has no effect."""
        self.destroy_node()

    def destroy_node(self) -> None:
        self._server.close()
        self._images.close()
        self._stop_listening()
        self._stop_listening = _nothing
        super().destroy_node()

    # -- data for the clients ----------------------------------------------------

    def _on_graph_change(self) -> None:
        """Schedule one refresh for any number of changes.

        A client that opens and closes channels changes the graph: refreshes are rare,
        and share the time that commands of clients may take.
        """
        if self._refreshing:
            return
        self._refreshing = True
        wait_s = self._refreshed_s + _REFRESH_S - self._wall.now_s
        if wait_s <= 0.0:
            self._commands.add(_GRAPH, self._refresh)
        else:
            self.call_later(wait_s, partial(self._commands.add, _GRAPH, self._refresh))

    def _refresh(self) -> None:
        self._refreshing = False
        self._refreshed_s = self._wall.now_s
        self._frames = (
            self._frame("map_frame", "map"),
            self._frame("base_frame", "base_link"),
        )
        ends = self._topic_ends()
        servers = self._servers()
        topics = topics_of(ends, self._definition)
        services = (self._offered(*key) for key in sorted({s[:2] for s in servers}))
        graph = graph_of(ends, ((service, node) for service, _, node in servers))
        self._server.call(self._hub.subscriptions.set_topics, topics)
        self._server.call(self._hub.services.set_services, [s for s in services if s])
        self._server.call(self._hub.set_graph, graph)
        self._remote.set_nodes(self._serving_elsewhere())

    def _frame(self, parameter: str, default: str) -> str:
        """Return the viewer's parameter, else that of the first node that has it."""
        for node in (self, *self.context.nodes):
            if node.has_parameter(parameter):
                frame = str(node.get_parameter(parameter).value)
                if frame:
                    return frame
        return default

    def _topic_ends(self) -> list[TopicEnd]:
        """Return all endpoints except the viewer's own subscriptions."""
        own = self.get_fully_qualified_name()
        found = (
            TopicEnd(
                topic=endpoint.topic,
                type_name=endpoint.type_name,
                node=endpoint.node_full_name,
                publishes=endpoint.kind.name == "PUBLISHER",
                latched=endpoint.qos.is_latched,
            )
            for endpoint in self.context.graph.endpoints()
        )
        ends = [end for end in found if end.publishes or end.node != own]
        made = compressed_ends(ends, own)
        self._compressed = {end.topic for end in made}
        return ends + made

    def _servers(self) -> list[tuple[str, str, str]]:
        """Return name, type and node of each service that clients may need.

        Without parts of actions and services of every node, such as parameters, which
        have their own requests.
        """
        return [
            (end.topic, end.type_name, end.node_full_name)
            for end in self.context.graph.service_endpoints()
            if end.kind.name == "SERVICE"
            and not is_hidden(end.topic)
            and end.type_name.partition("/")[0] not in _EVERY_NODE
        ]

    def _offered(self, name: str, type_name: str) -> OfferedService | None:
        request = self._definition(name, f"{type_name}_Request")
        response = self._definition(name, f"{type_name}_Response")
        if request is None or response is None:
            return None
        return OfferedService(name, type_name, request, response)

    def _definition(self, topic: str, type_name: str) -> str | None:
        """Return the type's definition; None, and one warning, for an unknown type."""
        if type_name not in self._definitions:
            try:
                self._definitions[type_name] = definition_text(type_name)
            except UnknownNameError as error:
                self._definitions[type_name] = None
                self.get_logger().warning(f"cannot show {topic}: {error}")
        return self._definitions[type_name]

    # -- ProgramCommands (executor thread) -----------------------------------------

    def watch(self, watch: Watch) -> None:
        """Subscribe for one client, or for all; again, if subscribed already.

        A new subscription receives latched messages again.
        """
        self.unwatch(watch)
        channel = watch.channel
        if channel.topic in self._compressed and channel.type_name == COMPRESSED:
            self._watched[watch] = self._compress(watch)
            return
        try:
            interface = get_interface(channel.type_name)
            is_grid = interface is OccupancyGrid
            self._watched[watch] = self.create_subscription(
                interface,
                channel.topic,
                partial(self._forward_grid if is_grid else self._forward, watch),
                qos_profile_best_available,  # latched messages too
                raw=not is_grid,  # forwarded without decoding
                shared=is_grid,
                other_types=self.context.graph.topics().get(channel.topic, ()),
            )
        except NavetteError as error:  # the topic changed after it was advertised
            self.get_logger().warning(f"cannot watch {channel.topic}: {error}")

    def _compress(self, watch: Watch) -> Subscription[Any]:
        """Subscribe to a camera for a topic that the live view makes itself."""

        def deliver(image: CompressedImage) -> None:
            self._forward(watch, serialize(image))

        return self.create_subscription(
            Image,
            watch.channel.topic.removesuffix(SUFFIX),
            self._images.stream(deliver),
            qos_profile_best_available,
            shared=True,
        )

    def unwatch(self, watch: Watch) -> None:
        subscription = self._watched.pop(watch, None)
        if subscription is not None:
            self.destroy_subscription(subscription)

    def open_publisher(self, client: int, channel: ClientChannel) -> None:
        self._execute(client, self._publishers.open, client, channel)

    def close_publisher(self, client: int, channel_id: int) -> None:
        self._execute(client, self._publishers.close, client, channel_id)

    def publish_from_client(self, client: int, channel_id: int, data: bytes) -> None:
        self._execute(client, self._publishers.publish, client, channel_id, data)

    def request_parameters(
        self, client: int, names: tuple[str, ...], request_id: str | None
    ) -> None:
        self._parameters.get(client, names, request_id)

    def change_parameters(
        self,
        client: int,
        parameters: tuple[WireParameter, ...],
        request_id: str | None,
    ) -> None:
        self._parameters.set(client, parameters, request_id)

    def request_parameter_texts(self, client: int) -> None:
        self._parameters.describe(client)

    def call_service(
        self, call_id: CallId, service: OfferedService, encoding: str, data: bytes
    ) -> None:
        self._services.call(call_id, service, encoding, data)

    def control_playback(self, client: int, request: ControlPlayback) -> None:
        self._execute(client, self._playback.control, request)

    def step_playback(self, client: int) -> None:
        self._execute(client, self._playback.step)

    def _forward(self, watch: Watch, payload: Payload) -> None:
        self._server.offer(watch, self.now_ns, payload)

    def _forward_grid(self, watch: Watch, grid: OccupancyGrid) -> None:
        self._forward(watch, payload_of(grid))

    @property
    def now_ns(self) -> int:
        """The time that clients display; callable from any thread."""
        position_ns = self._playback.position_ns()
        return self.get_clock().now_ns if position_ns is None else position_ns

    # -- ThreadBridge ----------------------------------------------------------------

    def call_hub(self, method: Callable[..., None], *args: Any) -> None:
        self._server.call(method, *args)

    def call_later(self, delay_s: float, function: Callable[[], None]) -> None:
        self._server.call_later(delay_s, function)

    def run_soon(self, function: Callable[[], object], source: str) -> None:
        self.context.loop.call_soon_threadsafe(
            function, f"viewer {source}", self.get_fully_qualified_name()
        )

    def _execute(self, client: int, request: Callable[..., None], *args: Any) -> None:
        """Execute a client's request; an error is sent back to that client."""
        try:
            request(*args)
        except NavetteError as error:
            self._server.call(self._hub.send_status, client, str(error))
        finally:
            self._server.call(self._hub.done, client)

    # -- GraphAccess -----------------------------------------------------------------

    def local_nodes(self) -> Iterable[LocalNode]:
        nodes: list[LocalNode] = self.context.nodes
        return nodes

    def node_names(self) -> set[str]:
        return {info.full_name for info in self.context.graph.nodes()}

    def make_parameter(self, name: str, value: Any) -> Parameter[Any]:
        try:
            parameter: Parameter[Any] = Parameter(name, value=value)
            serialize(parameter.to_parameter_msg())  # must be possible
        except (MessageError, TypeError, ValueError) as error:
            raise ParameterError(str(error)) from None
        return parameter

    # -- ProblemReports --------------------------------------------------------------

    def image_refused(self, reason: str) -> None:
        self._warn_soon(f"an image was not compressed: {reason}", "image")

    def origin_refused(self, reason: str) -> None:
        self._warn_soon(f"a page was refused: {reason}", "refused origin")

    def user_refused(self) -> None:
        """Print the address with the token once, when another user tries to connect.

        Not by the logger: log messages are published and recorded.
        """
        if self._access.is_remote or self._denial_noted:
            return
        self._denial_noted = True
        url = self._access.remote_url(self.params.host, self.port)
        sys.stderr.write(
            "live view: refused a program of another user; for access it needs the "
            f"token: {url}\n"
        )

    def _warn_soon(self, text: str, source: str) -> None:
        self.run_soon(lambda: self.get_logger().warning(text), source)

    # -- SiteDocuments ---------------------------------------------------------------

    def layout(self) -> Mapping[str, Any]:
        return build_layout(*self._frames)

    def health(self) -> Mapping[str, Any]:
        return {
            "status": "ok",
            "version": __version__,
            "clients": self._hub.clients,
            "topics": len(self._hub.subscriptions.channels),
            "time_s": self.now_ns / 1e9,
        }

    # -- internals -----------------------------------------------------------------

    def _monitor_nodes(self) -> ParameterRequests:
        calls = ServiceCalls(graph=self, clock=self._wall)
        self._services = ServiceRequests(self._hub.services, calls, bridge=self)
        self._remote = RemoteParameters(
            self._hub.reports,
            bridge=self,
            graph=self,
            service_calls=calls,
            clock=self._wall,
        )
        self._monitor = NodeMonitor(
            self._hub.reports,
            bridge=self,
            graph=self,
            service_calls=calls,
            remote=self._remote,
            clock=self._wall,
        )
        return ParameterRequests(
            self._hub, bridge=self, graph=self, remote=self._remote
        )

    def _serving_elsewhere(self) -> dict[str, bytes]:
        """Return the gid of each node of another process that serves parameters."""
        here = {node.get_fully_qualified_name() for node in self.context.nodes}
        return {
            end.node_full_name: end.gid
            for end in self.context.graph.service_endpoints()
            if end.type_name == LIST
            and end.kind.name == "SERVICE"
            and end.topic == f"{end.node_full_name}/list_parameters"
            and end.node_full_name not in here
        }

    def _make_server(self, listeners: Listeners | None) -> ViewerServer:
        params = self.params
        page = importlib.resources.files("navette.viewer") / "page"
        gate = Gate(
            AccessPolicy(params.host, params.allowed_origins, params.allowed_hosts),
            self._access.login,
            Site(read_page(page), documents=self),
            problems=self,
        )
        return ViewerServer(
            self._hub,
            gate,
            tls=self._access.tls,
            listeners=listeners or listen(params.host, params.port),
            time=self,
            clock=self._wall,
            monitor=self._monitor,
            time_rate_hz=params.time_rate_hz,
            max_clients=params.max_clients,
        )


def _range(playback: Playback) -> tuple[int, int]:
    return playback.begin_ns, playback.end_ns


def _nothing() -> None:
    """No graph subscription to end."""


def _refuse_changes(parameters: list[Parameter[Any]]) -> SetParametersResult:
    """Refuse changes: the server is created once, with its initial parameters."""
    fixed = {field.name for field in fields(ViewerParams)}
    for parameter in parameters:
        if parameter.name in fixed:
            reason = f"{parameter.name} can be set at the start only"
            return SetParametersResult(successful=False, reason=reason)
    return SetParametersResult(successful=True)
