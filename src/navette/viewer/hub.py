"""The clients of the live view and what is sent to all of them. No socket, no node.

The socket thread passes client frames in (:meth:`Hub.receive`) and takes frames out of
each client's outbox; the program passes topics, messages and values in. Requests to the
program go out as :class:`~navette.viewer.session.ProgramCommands`. All methods of the
hub and its parts belong to the socket thread.
"""

import itertools
from collections.abc import Callable
from typing import Any

from navette.errors import DecodeError
from navette.viewer import frames, replies
from navette.viewer.assets import AssetFolders
from navette.viewer.client_channels import ClientChannels
from navette.viewer.command_queue import CommandRunner
from navette.viewer.node_reports import NodeReports
from navette.viewer.offered_services import OfferedServices
from navette.viewer.outbox import Outbox
from navette.viewer.playback import PlaybackState
from navette.viewer.replies import ConnectionGraph, Level
from navette.viewer.session import ProgramCommands, Session
from navette.viewer.subscriptions import Subscriptions

_MAX_QUEUED = 256 * 2**20  # bytes for all clients; beyond, no files are sent
_TIME = "time"

_Handler = Callable[[Session, Any], None]


class Hub:
    """Connected clients; each part handles the requests of one subject.

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
        self._client_ids = itertools.count(1)
        self._sessions: dict[int, Session] = {}
        self.subscriptions = Subscriptions(program, commands, self._sessions)
        self.client_channels = ClientChannels(program, self._sessions)
        self.services = OfferedServices(program, self._sessions)
        self.reports = NodeReports(program, self._sessions)
        self._handlers = self._handler_by_request()
        self.now_ns = 0

    def _handler_by_request(self) -> dict[type[frames.ClientFrame], _Handler]:
        return {
            frames.Subscribe: self.subscriptions.subscribe,
            frames.Unsubscribe: self.subscriptions.unsubscribe,
            frames.ApplyGridUpdates: self.subscriptions.apply_grid_updates,
            frames.Advertise: self.client_channels.advertise,
            frames.Unadvertise: self.client_channels.unadvertise,
            frames.Publish: self.client_channels.publish,
            frames.CallService: self.services.call,
            frames.WatchGraph: self.reports.watch_graph,
            frames.WatchNodes: self.reports.watch_nodes,
            frames.GetParameters: self.reports.get_parameters,
            frames.SetParameters: self.reports.set_parameters,
            frames.WatchParameters: self.reports.watch_parameters,
            frames.UnwatchParameters: self.reports.unwatch_parameters,
            frames.FetchAsset: self._fetch_asset,
            frames.ControlPlayback: self._control_playback,
            frames.StepPlayback: self._step_playback,
        }

    # -- clients -------------------------------------------------------------------

    @property
    def clients(self) -> int:
        return len(self._sessions)

    def join(self, outbox: Outbox) -> Session:
        session = Session(next(self._client_ids), outbox, self._commands)
        self._sessions[session.id] = session
        session.send(self._info)
        session.send(self.subscriptions.advertisement)
        if self.services.advertisement:
            session.send(self.services.advertisement)
        if self.now_ns:
            session.send(replies.time(self.now_ns))
        if self._playback is not None:
            session.send(self._playback)
        return session

    def leave(self, session: Session) -> None:
        self.subscriptions.end_all(session)
        self.client_channels.close_all(session)
        self._sessions.pop(session.id, None)

    def receive(self, session: Session, frame: str | bytes) -> None:
        """Handle one frame; an error in it is sent back as a status message."""
        try:
            request = frames.decode(frame)
        except DecodeError as error:
            session.send_status(str(error))
            return
        self._handlers[type(request)](session, request)

    def done(self, client: int) -> None:
        session = self._sessions.get(client)
        if session is not None:
            session.pending -= 1

    def send_status(
        self, client: int, message: str, level: Level = Level.ERROR
    ) -> None:
        session = self._sessions.get(client)
        if session is not None:
            session.send_status(message, level)

    # -- data from the program -------------------------------------------------------

    def set_graph(self, graph: ConnectionGraph) -> None:
        self.subscriptions.set_published(graph.published.keys())
        self.reports.set_graph(graph)

    def set_now(self, now_ns: int) -> None:
        """Send the time to all clients; only the newest is queued for a slow one."""
        if now_ns == self.now_ns:
            return
        if now_ns < self.now_ns:
            self.subscriptions.clear_grid_copies()
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
            self.subscriptions.drop_messages()
        for session in self._sessions.values():
            session.send(frame)

    # -- requests of clients -----------------------------------------------------------

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

    def _control_playback(
        self, session: Session, request: frames.ControlPlayback
    ) -> None:
        if self._can_play(session):
            session.add_command(self._program.control_playback, request)

    def _step_playback(self, session: Session, _request: frames.StepPlayback) -> None:
        if self._can_play(session):
            session.add_command(self._program.step_playback)

    def _can_play(self, session: Session) -> bool:
        if not self._plays:
            session.send_status(
                "playback control: the server does not play a recording"
            )
        return self._plays
