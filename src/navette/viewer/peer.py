"""One client's connection in the socket thread."""

import asyncio
import contextlib

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from navette.viewer.session import Session

_MAX_PENDING = 64  # unfinished requests of one client


class Peer:
    """A client's connection, the frames queued for it and its unfinished requests."""

    def __init__(self, connection: ServerConnection, session: Session) -> None:
        self.connection = connection
        self.session = session
        #: Aborted: frames that still arrive are ignored.
        self.gone = False
        self._outbox = session.outbox
        self._answered = asyncio.Event()
        self._filled = asyncio.Event()

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

    async def wait_for_answers(self) -> None:
        """Return when fewer than the maximum of requests are unfinished."""
        while self.session.pending >= _MAX_PENDING and not self.gone:
            self._answered.clear()
            await self._answered.wait()

    async def send(self) -> None:
        """Send queued frames at the rate at which the client reads them."""
        with contextlib.suppress(ConnectionClosed):
            while True:
                await self._filled.wait()
                self._filled.clear()
                while self._outbox:
                    await self.connection.send(self._outbox.pop())
