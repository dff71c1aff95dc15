"""The socket thread: one port that speaks WebSocket and plain HTTP.

An asyncio loop in a thread of its own owns the hub and all sockets. Other threads
reach it through :meth:`ViewerServer.call` and :meth:`ViewerServer.offer`, which
never wait.
"""

import asyncio
import contextlib
import errno
import logging
import threading
from collections.abc import Callable
from concurrent.futures import Future
from http import HTTPStatus
from typing import Any

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from navette.errors import InvalidValueError, NavetteError
from navette.viewer.frames import SUBPROTOCOLS
from navette.viewer.heartbeats import PERIOD_S
from navette.viewer.hub import Hub
from navette.viewer.offers import OfferQueue
from navette.viewer.outbox import Outbox
from navette.viewer.peer import Peer
from navette.viewer.session import Watch
from navette.viewer.web import Answer, Gate, Site, refuse

# Connections that come, go and fail to open are every day's business: only what is
# wrong in here is worth a line.
_log = logging.getLogger(__name__)
_log.setLevel(logging.ERROR)
_log.addFilter(lambda record: record.msg != "opening handshake failed")

_MAX_FRAME = 16 * 2**20  # bytes of one client frame; a larger one ends the connection
_SEND_BUFFER = 256 * 1024  # bytes in flight per client before frames queue up
_OPEN_S = 2.0  # for a request to come; browsers open connections in advance
_CLOSE_S = 1.0


class ViewerServer:
    """Serves a hub and a site on one port, in its own thread.

    Args:
        host: address to bind.
        port: TCP port; 0 takes a free one, see :attr:`port`.
        now_ns: the program's time, asked from the socket thread.
        on_beat: called there every ``PERIOD_S`` of wall time.
    """

    def __init__(
        self,
        hub: Hub,
        site: Site,
        gate: Gate,
        *,
        host: str,
        port: int,
        now_ns: Callable[[], int],
        on_beat: Callable[[], None],
        time_rate_hz: float,
        max_clients: int,
    ) -> None:
        self._hub = hub
        self._site = site
        self._gate = gate
        self._host = host
        self.port = port
        self._now_ns = now_ns
        self._on_beat = on_beat
        self._tick_s = 1.0 / time_rate_hz
        self._max_clients = max_clients
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(
            target=self._run, name="navette-viewer", daemon=True
        )
        self._started: Future[None] = Future()
        self._stop = asyncio.Event()
        self._offers = OfferQueue(self._loop, self._hub.message, self._wake_clients)
        self._peers: set[Peer] = set()

    # -- any thread ------------------------------------------------------------

    def start(self) -> None:
        """Listen; returns when clients can connect.

        Raises:
            InvalidValueError: the address cannot be used; names it and says why.
        """
        self._thread.start()
        self._started.result()

    def close(self) -> None:
        """Let all clients go and end the thread; closing twice is harmless."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stop.set)
            self._thread.join()

    def call(self, function: Callable[..., None], *args: Any) -> None:
        """Run a hub method on the socket thread and send what it queued."""
        try:
            self._loop.call_soon_threadsafe(self._call, function, *args)
        except RuntimeError:
            if not self._loop.is_closed():
                raise

    def offer(self, watch: Watch, stamp_ns: int, payload: bytes) -> None:
        """Send a message to whoever watches; the oldest go when too many wait."""
        self._offers.add(watch, stamp_ns, payload)

    # -- socket thread ---------------------------------------------------------

    def _run(self) -> None:
        try:
            self._loop.run_until_complete(self._serve())
        except OSError as error:
            if self._started.done():
                raise
            self._started.set_exception(self._explain(error))
        finally:
            self._loop.close()
            self._started.cancel()  # start() must not wait for ever

    def _explain(self, error: OSError) -> NavetteError:
        where = f"viewer: cannot listen on {self._host} port {self.port}"
        if error.errno == errno.EADDRINUSE:
            return InvalidValueError(
                f"{where}: the port is in use; stop what uses it or choose another port"
            )
        return InvalidValueError(f"{where}: {error.strerror or error}")

    async def _serve(self) -> None:
        server = await serve(
            self._client,
            self._host,
            self.port,
            subprotocols=[Subprotocol(name) for name in SUBPROTOCOLS],
            process_request=self._answer,
            compression=None,  # costs more time than loopback gains
            max_size=_MAX_FRAME,
            write_limit=_SEND_BUFFER,
            open_timeout=_OPEN_S,
            close_timeout=_CLOSE_S,
            server_header=None,
            logger=_log,
        )
        self.port = _port_of(server)
        self._started.set_result(None)
        self._tick()
        self._beat()
        await self._stop.wait()
        await self._end(server)

    async def _end(self, server: Server) -> None:
        """Say good-bye; cut off who does not answer."""
        server.close()
        ended = asyncio.create_task(server.wait_closed())
        await asyncio.wait([ended], timeout=_CLOSE_S)
        for peer in self._peers:
            peer.abort()
        await ended

    def _answer(
        self, connection: ServerConnection, request: Request
    ) -> Response | None:
        """HTTP for whoever does not ask for a socket; None lets the socket open."""
        headers = request.headers
        refused = self._gate.refusal(headers.get("Host"), headers.get("Origin"))
        is_socket = headers.get("Upgrade", "").lower() == "websocket"
        if refused:
            return _response(refuse(403, refused))
        if not is_socket:
            method = getattr(request, "method", "GET")  # websockets < 16: GET only
            return _response(self._site.answer(method, request.path))
        if not _offers_subprotocol(headers):
            known = " or ".join(SUBPROTOCOLS)
            return _response(refuse(400, f"wanted the WebSocket subprotocol {known}"))
        if self._hub.clients >= self._max_clients:
            return _response(refuse(503, f"{self._max_clients} clients are connected"))
        return None

    async def _client(self, connection: ServerConnection) -> None:
        outbox = Outbox()
        session = self._hub.join(outbox)
        peer = Peer(connection, session, outbox)
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
        with contextlib.suppress(ConnectionClosed):  # how every client ends
            async for frame in peer.connection:
                if peer.gone:
                    return
                self._hub.receive(peer.session, frame)
                peer.wake()
                # Not reading further makes the client's own socket push back.
                await peer.wait_for_answers()

    def _call(self, function: Callable[..., None], *args: Any) -> None:
        function(*args)
        self._wake_clients()
        for peer in self._peers:
            peer.look_at_answers()

    def _wake_clients(self) -> None:
        for peer in self._peers:
            peer.wake()

    def _tick(self) -> None:
        if self._peers:
            self._hub.set_now(self._now_ns())
            self._wake_clients()
        if not self._stop.is_set():
            self._loop.call_later(self._tick_s, self._tick)

    def _beat(self) -> None:
        self._on_beat()
        self._wake_clients()
        if not self._stop.is_set():
            self._loop.call_later(PERIOD_S, self._beat)


def _offers_subprotocol(headers: Headers) -> bool:
    offered = ",".join(headers.get_all("Sec-WebSocket-Protocol")).split(",")
    return any(name.strip() in SUBPROTOCOLS for name in offered)


def _response(answer: Answer) -> Response:
    headers = Headers(
        {
            "Content-Type": answer.content_type,
            "Content-Length": str(len(answer.body)),
            "Cache-Control": "no-store",
            "X-Content-Type-Options": "nosniff",
            "Connection": "close",
            **answer.headers,
        }
    )
    status = HTTPStatus(answer.status)
    return Response(status.value, status.phrase, headers, answer.body)


def _port_of(server: Server) -> int:
    return int(next(iter(server.sockets)).getsockname()[1])
