"""One client's connection in the socket thread."""

import asyncio
import contextlib

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from navette.viewer.hub import Hub
from navette.viewer.session import Session
from navette.viewer.token_bucket import TokenBucket
from navette.viewer.wall_clock import WallClock

_MAX_PENDING = 16  # unfinished requests of one client
_MAX_UNREAD = 4 * 2**20  # bytes of responses that a client has not received
_STALL_S = 1.0  # after which a client that has not accepted a frame is suspended
# Requests of one client. Teleoperation sends 10 a second, a page that opens about 100.
_REQUEST_BURST, _REQUESTS_PER_S = 1000, 200
_BYTE_BURST, _BYTES_PER_S = 16 * 2**20, 8 * 2**20


class Peer:
    """A client's connection, the frames queued for it and its unfinished requests."""

    def __init__(
        self,
        connection: ServerConnection,
        session: Session,
        *,
        hub: Hub,
        clock: WallClock,
    ) -> None:
        self.connection = connection
        self.session = session
        self._hub = hub
        self._clock = clock
        #: Aborted: frames that still arrive are ignored.
        self.gone = False
        self._outbox = session.outbox
        self._answered = asyncio.Event()
        self._filled = asyncio.Event()
        self._sending_since_s: float | None = None
        self._requests = TokenBucket(_REQUESTS_PER_S, _REQUEST_BURST, clock)
        self._bytes = TokenBucket(_BYTES_PER_S, _BYTE_BURST, clock)

    def wake(self) -> None:
        self._filled.set()
        if self._outbox.overflowed:
            # The client does not read, so a closing handshake would never complete.
            self.abort()

    def abort(self) -> None:
        """Cut the connection without a closing handshake."""
        self.gone = True
        self.connection.transport.abort()
        self.check_pending()

    def check_pending(self) -> None:
        self._answered.set()

    @property
    def is_stalled(self) -> bool:
        """Whether the client has not read what was sent to it for a second."""
        since_s = self._sending_since_s
        return since_s is not None and self._clock.now_s - since_s > _STALL_S

    async def admit(self, size: int) -> None:
        """Return when the client's next request may be read after one of ``size``.

        Waits while the client exceeds its rates, has too many unfinished requests or
        does not read the responses.
        """
        self._requests.take(1)
        self._bytes.take(size)
        wait_s = max(self._requests.wait_s(), self._bytes.wait_s())
        if wait_s:
            await asyncio.sleep(wait_s)
        while not self.gone and (
            self.session.pending >= _MAX_PENDING
            or self._outbox.control_size > _MAX_UNREAD
        ):
            self._answered.clear()
            await self._answered.wait()

    async def send(self) -> None:
        """Send queued frames at the rate at which the client reads them."""
        with contextlib.suppress(ConnectionClosed):
            while True:
                await self._filled.wait()
                self._filled.clear()
                while self._outbox:
                    self._sending_since_s = self._clock.now_s
                    await self.connection.send(self._outbox.pop())
                    self._sending_since_s = None
                    self._outbox.sent()
                    self.check_pending()
                if self.session.is_suspended:
                    self._hub.subscriptions.resume(self.session)
