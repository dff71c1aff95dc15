"""What clients request about the program's nodes: graph, states and parameters."""

from collections.abc import Iterable, Mapping

from navette.viewer import frames, replies
from navette.viewer.frames import WireParameter
from navette.viewer.liveness import NodeReport
from navette.viewer.parameters import ParameterText
from navette.viewer.replies import ConnectionGraph
from navette.viewer.session import ProgramCommands, Session

_MAX_PARAMETER_NAMES = 1000  # to whose changes a client subscribes
_NODES = "nodes"


class NodeReports:
    """Sends graph, states and parameters of nodes to the clients that request them.

    Args:
        sessions: the connected clients by id.
    """

    def __init__(
        self, program: ProgramCommands, sessions: Mapping[int, Session]
    ) -> None:
        self._program = program
        self._sessions = sessions
        self._graph = replies.EMPTY_GRAPH
        # Encoded once for any number of clients that subscribe.
        self._whole_graph: str | None = None

    @property
    def are_wanted(self) -> bool:
        """Whether a client needs data that nodes of other processes must provide."""
        return any(each.wants_node_reports for each in self._sessions.values())

    # -- graph and states ------------------------------------------------------------

    def watch_graph(self, session: Session, request: frames.WatchGraph) -> None:
        session.wants_graph = request.wanted
        if request.wanted and self._whole_graph is not None:
            session.send(self._whole_graph)

    def set_graph(self, graph: ConnectionGraph) -> None:
        update = replies.graph_update(self._graph, graph)
        self._graph = graph
        if update is None:
            return
        self._whole_graph = replies.graph_update(replies.EMPTY_GRAPH, graph)
        for session in self._sessions.values():
            if session.wants_graph:
                session.send(update)

    def watch_nodes(self, session: Session, request: frames.WatchNodes) -> None:
        session.wants_nodes = request.wanted
        if request.wanted:
            session.add_command(self._program.request_parameter_texts)

    def set_nodes(self, reports: Iterable[NodeReport], blocked_s: float) -> None:
        """Send the nodes' states; only the newest is queued for a slow client."""
        frame = replies.nodes(reports, blocked_s)
        for session in self._sessions.values():
            if session.wants_nodes:
                session.outbox.put_data(_NODES, frame, depth=1)

    # -- parameters --------------------------------------------------------------------

    def get_parameters(self, session: Session, request: frames.GetParameters) -> None:
        session.add_command(
            self._program.request_parameters, request.names, request.request_id
        )

    def set_parameters(self, session: Session, request: frames.SetParameters) -> None:
        session.add_command(
            self._program.change_parameters, request.parameters, request.request_id
        )

    def watch_parameters(
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

    def unwatch_parameters(
        self, session: Session, request: frames.UnwatchParameters
    ) -> None:
        session.parameter_names.difference_update(request.names)
        if not request.names:
            session.parameter_names.clear()
            session.all_parameters = False

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
