"""A client's connection in the socket thread: what waits for it, what it waits for."""

import asyncio
import contextlib

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from navette.viewer.outbox import Outbox
from navette.viewer.session import Session

_MAX_PENDING = 64  # requests of one client that may wait for the program


class Peer:
    """A client's connection and what waits for it."""

    def __init__(
        self, connection: ServerConnection, session: Session, outbox: Outbox
    ) -> None:
        self.connection = connection
        self.session = session
        #: Cut off: what it still has said does not count.
        self.gone = False
        self._outbox = outbox
        self._answered = asyncio.Event()
        self._filled = asyncio.Event()

    def wake(self) -> None:
        """There may be something to send."""
        self._filled.set()
        if self._outbox.overflowed:
            # It does not read: a word of good-bye would not get through.
            self.abort()

    def abort(self) -> None:
        """Cut the connection and wait for nothing."""
        self.gone = True
        self.connection.transport.abort()
        self.look_at_answers()

    def look_at_answers(self) -> None:
        """The program may have done some of what the client asked for."""
        self._answered.set()

    async def wait_for_answers(self) -> None:
        """Return when few enough of the client's requests are under way."""
        while self.session.pending >= _MAX_PENDING and not self.gone:
            self._answered.clear()
            await self._answered.wait()

    async def send(self) -> None:
        """Send what comes, at the pace at which the client takes it."""
        with contextlib.suppress(ConnectionClosed):
            while True:
                await self._filled.wait()
                self._filled.clear()
                while self._outbox:
                    await self.connection.send(self._outbox.pop())
