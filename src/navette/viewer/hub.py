"""State of the live view: clients, channels and subscriptions. No socket, no node.

The socket thread passes client frames in (:meth:`Hub.receive`) and takes frames out of
each client's outbox; the program passes topics, messages and values in. Requests to the
program go out as :class:`~navette.viewer.session.ProgramCommands`. All methods belong
to the socket thread.
"""

import itertools
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from navette.errors import DecodeError
from navette.viewer import frames, replies
from navette.viewer.assets import AssetFolders
from navette.viewer.command_queue import CommandRunner
from navette.viewer.frames import ClientChannel, WireParameter
from navette.viewer.grid_copies import GridCopies
from navette.viewer.large_grid import Payload
from navette.viewer.last_value_cache import LastValueCache
from navette.viewer.liveness import NodeReport
from navette.viewer.offered_services import OfferedServices
from navette.viewer.outbox import MessageFrame, Outbox
from navette.viewer.parameters import ParameterText
from navette.viewer.playback import PlaybackState
from navette.viewer.replies import Channel, ConnectionGraph, Level, OfferedService
from navette.viewer.session import CallId, ProgramCommands, Session, Topic, Watch
from navette.viewer.traffic import Traffic

_MAX_CLIENT_CHANNELS = 64
_MAX_CALLS = 32  # of services by a client, without a response
_MAX_CHANNELS = 256  # opened by all clients together
_MAX_PARAMETER_NAMES = 1000  # to whose changes a client subscribes
_MAX_QUEUED = 256 * 2**20  # bytes for all clients; beyond, no files are sent
_MAX_PROBLEMS = 3  # of a request that are reported one by one
_TIME, _NODES = "time", "nodes"
_WATCHES = 0  # lane of the subscriptions that clients share


class Hub:
    """Clients, channels and subscriptions.

    Args:
        program: executes the clients' requests.
        commands: runs the methods of ``program``.
    """

    def __init__(
        self,
        program: ProgramCommands,
        commands: CommandRunner,
        *,
        name: str,
        session_id: str,
        assets: AssetFolders | None = None,
        playback_range: tuple[int, int] | None = None,
    ) -> None:
        self._program = program
        self._commands = commands
        self._info = replies.server_info(name, session_id, playback_range)
        self._plays = playback_range is not None
        self._playback: bytes | None = None
        self._assets = assets or AssetFolders({})
        self._sessions: dict[int, Session] = {}
        self._channels: dict[int, Channel] = {}
        self._topics: dict[Topic, Channel] = {}
        self._watchers: dict[Watch, set[int]] = {}
        self._last = LastValueCache()
        self._traffic = Traffic()
        self._services = OfferedServices()
        self._graph = replies.EMPTY_GRAPH
        # Encoded once for any number of clients that join.
        self._advertisement = replies.advertise(())
        self._whole_graph: str | None = None
        self._client_ids = itertools.count(1)
        self._channel_ids = itertools.count(1)
        self.now_ns = 0

    @property
    def clients(self) -> int:
        return len(self._sessions)

    @property
    def channels(self) -> tuple[Channel, ...]:
        return tuple(self._channels.values())

    @property
    def wants_node_reports(self) -> bool:
        """Whether a client needs data that nodes of other processes must provide."""
        return any(each.wants_node_reports for each in self._sessions.values())

    # -- clients ---------------------------------------------------------------

    def join(self, outbox: Outbox) -> Session:
        session = Session(next(self._client_ids), outbox)
        self._sessions[session.id] = session
        session.send(self._info)
        session.send(self._advertisement)
        if self._services.advertisement:
            session.send(self._services.advertisement)
        if self.now_ns:
            session.send(replies.time(self.now_ns))
        if self._playback is not None:
            session.send(self._playback)
        return session

    def leave(self, session: Session) -> None:
        for subscription_id in list(session.channel_by_subscription):
            self._unsubscribe(session, subscription_id)
        for channel_id in list(session.client_channels):
            del session.client_channels[channel_id]
            self._request(session, self._program.close_publisher, channel_id)
        self._sessions.pop(session.id, None)

    def suspend(self, session: Session) -> None:
        """Deliver no more streams to a client that does not read.

        Topics that no other client shows are no longer subscribed, so that no camera
        is rendered for it. What is sent rarely (goals, states) is queued further: the
        next message may not come. Called again while the client does not read, since
        a topic may become a stream.
        """
        session.is_suspended = True
        for channel_id in session.subscription_by_channel:
            channel = self._channels[channel_id]
            is_stream = channel_id in self._traffic.streams and not channel.latched
            if is_stream and channel_id not in session.suspended_channels:
                session.suspended_channels.add(channel_id)
                self._remove_watcher(session, channel)

    def end_period(self) -> None:
        """Count the messages of the next period; called at a constant rate."""
        self._traffic.end_period()

    def resume(self, session: Session) -> None:
        """Deliver streams again, from the newest message on."""
        session.is_suspended = False
        for channel_id in session.suspended_channels:
            self._add_watcher(session, self._channels[channel_id])
        session.suspended_channels.clear()

    def receive(self, session: Session, frame: str | bytes) -> None:
        """Handle one frame; an error in it is sent back as a status message."""
        try:
            request = frames.decode(frame)
        except DecodeError as error:
            session.send_status(str(error))
            return
        _HANDLERS[type(request)](self, session, request)

    def done(self, client: int) -> None:
        session = self._sessions.get(client)
        if session is not None:
            session.pending -= 1

    # -- data from the program --------------------------------------------------

    def set_topics(self, topics: Iterable[Topic]) -> None:
        wanted = dict.fromkeys(topics)
        gone = [self._topics.pop(topic) for topic in list(self._topics.keys() - wanted)]
        for channel in gone:
            self._remove_channel(channel)
        if gone:
            self._broadcast(replies.unadvertise(sorted(channel.id for channel in gone)))
        added = []
        for topic in wanted:
            if topic not in self._topics:
                channel = Channel(
                    next(self._channel_ids),
                    topic.name,
                    topic.type_name,
                    topic.definition,
                    topic.latched,
                )
                self._topics[topic] = self._channels[channel.id] = channel
                added.append(channel)
        if added:
            self._broadcast(replies.advertise(added))
        if gone or added:
            self._advertisement = replies.advertise(self._channels.values())

    def set_services(self, services: Iterable[OfferedService]) -> None:
        for frame in self._services.update(services):
            self._broadcast(frame)

    def message(self, watch: Watch, stamp_ns: int, payload: Payload) -> None:
        channel_id = watch.channel.id
        self._traffic.add(channel_id, len(payload))
        for client in self._watchers.get(watch, ()):
            session = self._sessions[client]
            subscription_id = session.subscription_by_channel[channel_id]
            frame = MessageFrame(subscription_id, stamp_ns, payload)
            session.put(watch.channel, frame)
        if channel_id in self._last:
            self._last.store(channel_id, stamp_ns, payload)
            self._drop_unwatched(watch)

    def set_graph(self, graph: ConnectionGraph) -> None:
        update = replies.graph_update(self._graph, graph)
        if update is not None:
            self._whole_graph = replies.graph_update(replies.EMPTY_GRAPH, graph)
        self._graph = graph
        for topic, channel in self._topics.items():
            if topic.is_kept:
                self._keep(channel, is_published=topic.name in graph.published)
        if update is not None:
            for session in self._sessions.values():
                if session.wants_graph:
                    session.send(update)

    def set_now(self, now_ns: int) -> None:
        """Send the time to all clients; only the newest is queued for a slow one."""
        if now_ns == self.now_ns:
            return
        if now_ns < self.now_ns:
            self._clear_grid_copies()
        self.now_ns = now_ns
        frame = replies.time(now_ns)
        for session in self._sessions.values():
            session.outbox.put_data(_TIME, frame, depth=1)

    def set_playback(
        self, state: PlaybackState, *, did_seek: bool, request_id: str
    ) -> None:
        """Send the state of the recording to all clients, now and when they join."""
        frame = replies.playback_state(state, did_seek=did_seek, request_id=request_id)
        self._playback = replies.playback_state(state, did_seek=False, request_id="")
        if did_seek:
            self._last.clear()
            self._clear_grid_copies()
        for session in self._sessions.values():
            if did_seek:  # queued messages are from before the seek
                for subscription_id in session.channel_by_subscription:
                    session.outbox.forget(subscription_id)
            session.send(frame)

    def _clear_grid_copies(self) -> None:
        for session in self._sessions.values():
            if session.grid_copies is not None:
                session.grid_copies.clear()

    def parameters(
        self,
        client: int,
        parameters: Iterable[WireParameter],
        request_id: str | None,
    ) -> None:
        session = self._sessions.get(client)
        if session is not None:
            session.send(replies.parameter_values(parameters, request_id))

    def parameters_changed(self, parameters: Iterable[WireParameter]) -> None:
        changed = list(parameters)
        for session in self._sessions.values():
            wanted = [p for p in changed if session.wants_parameter(p.name)]
            if wanted:
                session.send(replies.parameter_values(wanted, None))

    def set_parameter_texts(
        self, texts: Iterable[ParameterText], client: int | None = None
    ) -> None:
        """Send parameter texts to one client, or to all that subscribed to nodes."""
        frame = replies.parameter_texts(texts)
        for session in self._sessions.values():
            if session.wants_nodes and client in (None, session.id):
                session.send(frame)

    def set_nodes(self, reports: Iterable[NodeReport], blocked_s: float) -> None:
        """Send the nodes' states; only the newest is queued for a slow client."""
        frame = replies.nodes(reports, blocked_s)
        for session in self._sessions.values():
            if session.wants_nodes:
                session.outbox.put_data(_NODES, frame, depth=1)

    def service_responded(self, call_id: CallId, encoding: str, data: bytes) -> None:
        number, service_id = call_id.number, call_id.service_id
        frame = replies.service_response(service_id, number, encoding, data)
        self._end_call(call_id, frame)

    def service_failed(self, call_id: CallId, reason: str) -> None:
        number, service_id = call_id.number, call_id.service_id
        self._end_call(call_id, replies.service_failure(service_id, number, reason))

    def _end_call(self, call_id: CallId, frame: str | bytes) -> None:
        session = self._sessions.get(call_id.client)
        if session is not None:
            session.calls.discard(call_id)
            session.send(frame)

    def send_status(
        self, client: int, message: str, level: Level = Level.ERROR
    ) -> None:
        session = self._sessions.get(client)
        if session is not None:
            session.send_status(message, level)

    # -- client requests -------------------------------------------------------

    def _subscribe(self, session: Session, request: frames.Subscribe) -> None:
        problems = []
        for subscription_id, channel_id in request.subscriptions:
            channel = self._channels.get(channel_id)
            if channel is None:
                problems.append(f"unknown channel id {channel_id}")
            elif subscription_id in session.channel_by_subscription:
                problems.append(f"id {subscription_id} is in use")
            elif channel_id in session.subscription_by_channel:
                problems.append(f"channel {channel_id} ({channel.topic}) is subscribed")
            else:
                session.channel_by_subscription[subscription_id] = channel_id
                session.subscription_by_channel[channel_id] = subscription_id
                self._add_watcher(session, channel)
        _report(session, "subscribe", problems)

    def _on_unsubscribe(self, session: Session, request: frames.Unsubscribe) -> None:
        problems = []
        for subscription_id in request.subscription_ids:
            if subscription_id in session.channel_by_subscription:
                self._unsubscribe(session, subscription_id)
            else:
                problems.append(f"unknown subscription id {subscription_id}")
        _report(session, "unsubscribe", problems, Level.WARNING)

    def _unsubscribe(self, session: Session, subscription_id: int) -> None:
        channel_id = session.channel_by_subscription.pop(subscription_id)
        del session.subscription_by_channel[channel_id]
        session.outbox.forget(subscription_id)
        if session.grid_copies is not None:
            session.grid_copies.forget(subscription_id)
        if channel_id in session.suspended_channels:
            session.suspended_channels.discard(channel_id)
        else:
            self._remove_watcher(session, self._channels[channel_id])

    def _remove_watcher(self, session: Session, channel: Channel) -> None:
        watch = _watch_of(session, channel)
        self._watchers[watch].discard(session.id)
        self._drop_unwatched(watch)

    def _add_watcher(self, session: Session, channel: Channel) -> None:
        watch = _watch_of(session, channel)
        watchers = self._watchers.get(watch)
        if watchers is None:
            self._watchers[watch] = {session.id}
            self._watch(watch)
            return
        watchers.add(session.id)
        last = self._last.last(channel.id)
        if last is not None:
            subscription_id = session.subscription_by_channel[channel.id]
            session.put(channel, MessageFrame(subscription_id, *last))

    def _keep(self, channel: Channel, *, is_published: bool) -> None:
        """Subscribe without a client while the topic has a publisher."""
        watch = Watch(channel, None)
        if not is_published:
            self._last.close(channel.id)
            if watch in self._watchers:
                self._drop_unwatched(watch)
        elif self._last.open(channel.id) and watch not in self._watchers:
            self._watchers[watch] = set()
            self._watch(watch)

    def _drop_unwatched(self, watch: Watch) -> None:
        """Unsubscribe from a topic without clients, unless it is cached."""
        if not self._watchers[watch] and watch.channel.id not in self._last:
            del self._watchers[watch]
            self._unwatch(watch)

    def _advertise(self, session: Session, request: frames.Advertise) -> None:
        problems = []
        for channel in request.channels:
            problem = self._refusal(session, channel)
            if problem:
                problems.append(problem)
                continue
            session.client_channels[channel.id] = channel
            self._request(session, self._program.open_publisher, channel)
        _report(session, "advertise", problems)

    def _unadvertise(self, session: Session, request: frames.Unadvertise) -> None:
        problems = []
        for channel_id in request.channel_ids:
            if session.client_channels.pop(channel_id, None) is None:
                problems.append(f"unknown channel id {channel_id}")
            else:
                self._request(session, self._program.close_publisher, channel_id)
        _report(session, "unadvertise", problems, Level.WARNING)

    def _publish(self, session: Session, request: frames.Publish) -> None:
        if request.channel_id not in session.client_channels:
            session.send_status(
                f"publish: channel {request.channel_id} is not advertised"
            )
            return
        self._request(
            session, self._program.publish_from_client, request.channel_id, request.data
        )

    def _get_parameters(self, session: Session, request: frames.GetParameters) -> None:
        self._request(
            session, self._program.request_parameters, request.names, request.request_id
        )

    def _set_parameters(self, session: Session, request: frames.SetParameters) -> None:
        self._request(
            session,
            self._program.change_parameters,
            request.parameters,
            request.request_id,
        )

    def _watch_parameters(
        self, session: Session, request: frames.WatchParameters
    ) -> None:
        names = session.parameter_names.union(request.names)
        if len(names) > _MAX_PARAMETER_NAMES:
            session.send_status(
                "subscribeParameterUpdates: a client can name "
                f"{_MAX_PARAMETER_NAMES} parameters at most; without names, all are "
                "subscribed"
            )
            return
        session.parameter_names = names
        session.all_parameters = session.all_parameters or not request.names

    def _unwatch_parameters(
        self, session: Session, request: frames.UnwatchParameters
    ) -> None:
        session.parameter_names.difference_update(request.names)
        if not request.names:
            session.parameter_names.clear()
            session.all_parameters = False

    def _watch_graph(self, session: Session, request: frames.WatchGraph) -> None:
        session.wants_graph = request.wanted
        if request.wanted and self._whole_graph is not None:
            session.send(self._whole_graph)

    def _watch_nodes(self, session: Session, request: frames.WatchNodes) -> None:
        session.wants_nodes = request.wanted
        if request.wanted:
            self._request(session, self._program.request_parameter_texts)

    def _apply_grid_updates(
        self, session: Session, _request: frames.ApplyGridUpdates
    ) -> None:
        if session.grid_copies is None:
            session.grid_copies = GridCopies(session.outbox)

    def _fetch_asset(self, session: Session, request: frames.FetchAsset) -> None:
        if sum(each.outbox.size for each in self._sessions.values()) > _MAX_QUEUED:
            problem = "the clients have not received earlier data; request it again"
            session.send(replies.asset_error(request.request_id, problem))
            return
        try:
            data = self._assets.read(request.uri)
        except (LookupError, OSError) as error:
            session.send(replies.asset_error(request.request_id, str(error)))
        else:
            session.send(replies.asset(request.request_id, data))

    def _call_service(self, session: Session, request: frames.CallService) -> None:
        call_id = CallId(session.id, request.service_id, request.call_id)
        service = self._services.find(request.service_id)
        problem = ""
        if service is None:
            problem = f"unknown service id {request.service_id}"
        elif request.encoding not in replies.ENCODINGS:
            known = ", ".join(replies.ENCODINGS)
            problem = f"encoding {request.encoding!r:.80}; known: {known}"
        elif call_id in session.calls:
            problem = f"call id {request.call_id} is in use"
        elif len(session.calls) >= _MAX_CALLS:
            problem = f"{_MAX_CALLS} calls have no response yet"
        if service is None or problem:
            session.send(
                replies.service_failure(request.service_id, request.call_id, problem)
            )
            return
        session.calls.add(call_id)
        command = self._program.call_service
        self._commands.add(
            session.id,
            partial(command, call_id, service, request.encoding, request.data),
        )

    def _control_playback(
        self, session: Session, request: frames.ControlPlayback
    ) -> None:
        if self._can_play(session):
            self._request(session, self._program.control_playback, request)

    def _step_playback(self, session: Session, _request: frames.StepPlayback) -> None:
        if self._can_play(session):
            self._request(session, self._program.step_playback)

    def _can_play(self, session: Session) -> bool:
        if not self._plays:
            session.send_status(
                "playback control: the server does not play a recording"
            )
        return self._plays

    def _refusal(self, session: Session, channel: ClientChannel) -> str:
        """Return why a client's channel cannot be opened; empty if it can."""
        if channel.id in session.client_channels:
            return f"channel id {channel.id} is in use"
        if channel.encoding not in replies.ENCODINGS:
            return (
                f"encoding {channel.encoding!r:.80} of {channel.topic!r:.80}; "
                f"known: {', '.join(replies.ENCODINGS)}"
            )
        if len(session.client_channels) >= _MAX_CLIENT_CHANNELS:
            return f"a client can open {_MAX_CLIENT_CHANNELS} channels at most"
        opened = sum(len(each.client_channels) for each in self._sessions.values())
        if opened >= _MAX_CHANNELS:
            return f"all clients together can open {_MAX_CHANNELS} channels at most"
        return ""

    def _request(
        self, session: Session, command: Callable[..., None], *args: Any
    ) -> None:
        session.pending += 1
        self._commands.add(session.id, partial(command, session.id, *args))

    def _watch(self, watch: Watch) -> None:
        command = partial(self._program.watch, watch)
        self._commands.add(watch.client or _WATCHES, command, watch)

    def _unwatch(self, watch: Watch) -> None:
        command = partial(self._program.unwatch, watch)
        self._commands.add(watch.client or _WATCHES, command, watch, is_next=True)

    # -- internals ----------------------------------------------------------------

    def _remove_channel(self, channel: Channel) -> None:
        is_kept = channel.id in self._last
        self._last.close(channel.id)
        for session in self._sessions.values():
            subscription_id = session.subscription_by_channel.get(channel.id)
            if subscription_id is not None:
                self._unsubscribe(session, subscription_id)
        watch = Watch(channel, None)
        if is_kept and watch in self._watchers:  # subscribed for the cache only
            self._drop_unwatched(watch)
        del self._channels[channel.id]

    def _broadcast(self, frame: str | bytes) -> None:
        for session in self._sessions.values():
            session.send(frame)


_HANDLERS: dict[type, Callable[..., None]] = {
    frames.Subscribe: Hub._subscribe,
    frames.Unsubscribe: Hub._on_unsubscribe,
    frames.Advertise: Hub._advertise,
    frames.Unadvertise: Hub._unadvertise,
    frames.Publish: Hub._publish,
    frames.GetParameters: Hub._get_parameters,
    frames.SetParameters: Hub._set_parameters,
    frames.WatchParameters: Hub._watch_parameters,
    frames.UnwatchParameters: Hub._unwatch_parameters,
    frames.WatchGraph: Hub._watch_graph,
    frames.WatchNodes: Hub._watch_nodes,
    frames.ApplyGridUpdates: Hub._apply_grid_updates,
    frames.FetchAsset: Hub._fetch_asset,
    frames.CallService: Hub._call_service,
    frames.ControlPlayback: Hub._control_playback,
    frames.StepPlayback: Hub._step_playback,
}


def _watch_of(session: Session, channel: Channel) -> Watch:
    return Watch(channel, session.id if channel.latched else None)


def _report(
    session: Session, operation: str, problems: list[str], level: Level = Level.ERROR
) -> None:
    """Send the problems of a request, a bounded number of them one by one."""
    for problem in problems[:_MAX_PROBLEMS]:
        session.send_status(f"{operation}: {problem}", level)
    more = len(problems) - _MAX_PROBLEMS
    if more > 0:
        session.send_status(f"{operation}: {more} more entries are refused", level)
