"""The socket thread: WebSocket and plain HTTP on one port.

An asyncio loop in its own thread owns the hub and all sockets. Other threads use
:meth:`ViewerServer.call` and :meth:`ViewerServer.offer`, which never block.
"""

import asyncio
import contextlib
import logging
import socket
import ssl
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from http import HTTPStatus
from typing import Any

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from navette.viewer.connection import BoundedConnection, ConnectionLimit, bounded_by
from navette.viewer.frames import MAX_BINARY, SUBPROTOCOLS
from navette.viewer.gate import Gate, WebRequest
from navette.viewer.hub import Hub
from navette.viewer.large_grid import Payload
from navette.viewer.listening import Listeners, port_of
from navette.viewer.liveness import PERIOD_S
from navette.viewer.login import Visitor
from navette.viewer.node_monitor import NodeMonitor
from navette.viewer.offers import Offer, OfferQueue
from navette.viewer.outbox import Outbox
from navette.viewer.peer import Peer
from navette.viewer.peer_user import user_of
from navette.viewer.playback import DisplayClock
from navette.viewer.session import Watch
from navette.viewer.throttled_selector import ThrottledSelector
from navette.viewer.wall_clock import WallClock
from navette.viewer.web import HttpResponse, refuse

# Connections that open, close or fail are normal; only errors of the server are logged.
_log = logging.getLogger(__name__)
_log.setLevel(logging.ERROR)
_log.addFilter(lambda record: record.msg != "opening handshake failed")

# Work of the socket thread: the robot's nodes may run in the same process.
_WORK_SHARE, _WORK_BURST_S = 0.2, 0.05
_MAX_OPENING = 32  # connections besides the clients: HTTP requests and handshakes
_BACKLOG = 32  # connections accepted in one turn
_SEND_BUFFER = 256 * 1024  # bytes in flight per client before frames queue up
# Until a complete request, also of a page on a busy machine. Idle connections, which
# browsers open in advance, are the first to go when there are too many.
_OPEN_S = 10.0
_TLS_S = 2.0  # until the end of a TLS handshake, in which connections are not counted
_CLOSE_S = 1.0


class ViewerServer:
    """Serves a hub and a site on one port, in its own thread.

    Args:
        listeners: listening sockets, which are closed with the server.
        time: the time that clients display.
        monitor: checks the nodes every ``PERIOD_S`` of wall time.
    """

    def __init__(
        self,
        hub: Hub,
        gate: Gate,
        *,
        listeners: Listeners,
        tls: ssl.SSLContext | None = None,
        time: DisplayClock,
        clock: WallClock,
        monitor: NodeMonitor,
        time_rate_hz: float,
        max_clients: int,
    ) -> None:
        self._hub = hub
        self._gate = gate
        self._tls = tls
        self._listeners = listeners
        self.port = port_of(listeners)
        self._time = time
        self._clock = clock
        self._monitor = monitor
        self._tick_s = 1.0 / time_rate_hz
        self._max_clients = max_clients
        self._loop = asyncio.SelectorEventLoop(
            ThrottledSelector(_WORK_SHARE, _WORK_BURST_S, clock)
        )
        self._thread = threading.Thread(
            target=self._run, name="navette-viewer", daemon=True
        )
        self._started: Future[None] = Future()
        self._stop = asyncio.Event()
        self._offers = OfferQueue(self._loop, deliver=self._deliver)
        self._peers: set[Peer] = set()

    # -- any thread ------------------------------------------------------------

    def start(self) -> None:
        """Serve; return when the first clients are accepted."""
        self._thread.start()
        self._started.result()

    def close(self) -> None:
        """Disconnect all clients and end the thread; a second call has no effect."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stop.set)
            self._thread.join()
        for listener in self._listeners:
            listener.close()

    def call(self, function: Callable[..., None], *args: Any) -> None:
        """Run a hub method on the socket thread and send what it queued."""
        try:
            self._loop.call_soon_threadsafe(self._call, function, *args)
        except RuntimeError:
            if not self._loop.is_closed():
                raise

    def call_later(self, delay_s: float, function: Callable[[], None]) -> None:
        """Run ``function`` on the socket thread after a delay."""

        def schedule() -> None:
            self._loop.call_later(delay_s, function)

        self.call(schedule)

    def offer(self, watch: Watch, stamp_ns: int, payload: Payload) -> None:
        """Queue a message for its clients; drops the oldest when the queue is full."""
        self._offers.add(watch, stamp_ns, payload)

    # -- socket thread ---------------------------------------------------------

    def _run(self) -> None:
        try:
            self._loop.run_until_complete(self._serve())
        except OSError as error:
            if self._started.done():
                raise
            self._started.set_exception(error)
        finally:
            self._loop.close()
            self._started.cancel()  # start() must not block forever

    async def _serve(self) -> None:
        limit = ConnectionLimit(self._max_clients + _MAX_OPENING)
        connection = bounded_by(limit, self._clock)
        servers = [await self._accept(each, connection) for each in self._listeners]
        self._started.set_result(None)
        self._tick()
        self._run_period()
        await self._stop.wait()
        await self._end(servers, limit)

    async def _accept(
        self, listener: socket.socket, connection_class: type[BoundedConnection]
    ) -> Server:
        return await serve(
            self._client,
            sock=listener,
            ssl=self._tls,
            ssl_handshake_timeout=None if self._tls is None else _TLS_S,
            subprotocols=[Subprotocol(name) for name in SUBPROTOCOLS],
            process_request=self._answer,
            compression=None,  # costs more time than loopback gains
            create_connection=connection_class,
            backlog=_BACKLOG,
            max_size=MAX_BINARY,
            write_limit=_SEND_BUFFER,
            open_timeout=_OPEN_S,
            close_timeout=_CLOSE_S,
            server_header=None,
            logger=_log,
        )

    async def _end(self, servers: list[Server], limit: ConnectionLimit) -> None:
        """Close all connections; abort clients that do not complete the handshake."""
        limit.close()
        ended = []
        for server in servers:
            server.close()
            ended.append(asyncio.create_task(server.wait_closed()))
        await asyncio.wait(ended, timeout=_CLOSE_S)
        for peer in self._peers:
            peer.abort()
        await asyncio.gather(*ended)

    def _answer(
        self, connection: ServerConnection, request: Request
    ) -> Response | None:
        """Return an HTTP response, or None to open the WebSocket."""
        headers = request.headers
        asked = WebRequest(
            getattr(request, "method", "GET"),  # websockets < 16: GET only
            request.path,
            headers.get("Host"),
            headers.get("Origin"),
            headers.get("Authorization"),
            _visitor(connection),
            headers.get("Accept-Encoding", ""),
        )
        if headers.get("Upgrade", "").lower() != "websocket":
            return _response(self._gate.page(asked))
        refused = self._gate.refusal(asked)
        if refused is not None:
            return _response(refused)
        if not _offers_subprotocol(headers):
            known = " or ".join(SUBPROTOCOLS)
            return _response(refuse(400, f"the WebSocket subprotocol must be {known}"))
        if self._hub.clients >= self._max_clients:
            return _response(refuse(503, f"{self._max_clients} clients are connected"))
        return None

    async def _client(self, connection: ServerConnection) -> None:
        session = self._hub.join(Outbox())
        peer = Peer(connection, session, hub=self._hub, clock=self._clock)
        self._peers.add(peer)
        peer.wake()
        try:
            async with asyncio.TaskGroup() as group:
                sender = group.create_task(peer.send())
                await self._receive(peer)
                sender.cancel()
        finally:
            self._peers.discard(peer)
            self._hub.leave(session)

    async def _receive(self, peer: Peer) -> None:
        with contextlib.suppress(ConnectionClosed):  # the normal end
            async for frame in peer.connection:
                if peer.gone:
                    return
                self._hub.receive(peer.session, frame)
                peer.wake()
                # While nothing is read, TCP slows the client down.
                await peer.admit(len(frame))

    def _call(self, function: Callable[..., None], *args: Any) -> None:
        function(*args)
        self._wake_clients()
        for peer in self._peers:
            peer.check_pending()

    def _deliver(self, offers: Iterable[Offer]) -> None:
        for watch, stamp_ns, payload in offers:
            self._hub.subscriptions.message(watch, stamp_ns, payload)
        self._wake_clients()

    def _wake_clients(self) -> None:
        for peer in self._peers:
            peer.wake()

    def _tick(self) -> None:
        if self._peers:
            self._hub.set_now(self._time.now_ns)
            self._wake_clients()
        if not self._stop.is_set():
            self._loop.call_later(self._tick_s, self._tick)

    def _run_period(self) -> None:
        self._monitor.on_period()
        self._hub.subscriptions.end_period()
        for peer in self._peers:
            if peer.is_stalled:
                self._hub.subscriptions.suspend(peer.session)
        self._wake_clients()
        if not self._stop.is_set():
            self._loop.call_later(PERIOD_S, self._run_period)


def _visitor(connection: ServerConnection) -> Visitor:
    client, server = connection.remote_address[:2], connection.local_address[:2]
    encryption = connection.transport.get_extra_info("ssl_object")
    return Visitor(
        client[0],
        user_of(client, server),
        encryption is not None and bool(encryption.getpeercert()),
    )


def _offers_subprotocol(headers: Headers) -> bool:
    offered = ",".join(headers.get_all("Sec-WebSocket-Protocol")).split(",")
    return any(name.strip() in SUBPROTOCOLS for name in offered)


def _response(answer: HttpResponse) -> Response:
    headers = Headers(
        {
            "Content-Type": answer.content_type,
            "Content-Length": str(len(answer.body)),
            "Cache-Control": "no-store",
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Connection": "close",
            **answer.headers,
        }
    )
    status = HTTPStatus(answer.status)
    return Response(status.value, status.phrase, headers, answer.body)
