"""Bounds of one connection below the level of messages.

The WebSocket library bounds messages and HTTP headers, but not the number of fragments,
control frames (each is answered) and connections.
"""

from collections import OrderedDict
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.frames import CTRL_OPCODES, CloseCode, Frame
from websockets.protocol import Event

from navette.viewer.token_bucket import TokenBucket
from navette.viewer.wall_clock import WallClock

_MAX_FRAGMENTS = 256  # of a message
# Pings and pongs of a client; ordinary clients send less than one a second.
_CONTROL_BURST, _CONTROL_PER_S = 100, 10


class ConnectionLimit:
    """Connections of a server; those without a complete request are the first to go."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._opening: OrderedDict[BoundedConnection, None] = OrderedDict()
        self._count = 0

    def add(self, connection: "BoundedConnection") -> None:
        self._count += 1
        self._opening[connection] = None
        if self._count > self._most:
            oldest, _ = self._opening.popitem(last=False)
            oldest.transport.abort()

    def opened(self, connection: "BoundedConnection") -> None:
        """Note that the connection sent its request."""
        self._opening.pop(connection, None)

    def remove(self, connection: "BoundedConnection") -> None:
        self._count -= 1
        self._opening.pop(connection, None)

    def close(self) -> None:
        """Abort the connections without a complete request, also later ones."""
        self._most = 0
        for connection in self._opening:
            connection.transport.abort()


class BoundedConnection(ServerConnection):
    """A connection whose fragments and control frames are bounded."""

    limit: ConnectionLimit
    clock: WallClock

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        self._fragments = 0
        self._control = TokenBucket(_CONTROL_PER_S, _CONTROL_BURST, self.clock)
        self.limit.add(self)

    def connection_lost(self, exc: Exception | None) -> None:
        self.limit.remove(self)
        super().connection_lost(exc)

    def process_event(self, event: Event) -> None:
        self.limit.opened(self)
        if isinstance(event, Frame):
            problem = self._excess(event)
            if problem:
                self.protocol.fail(CloseCode.POLICY_VIOLATION, problem)
                self.send_data()
                return
        super().process_event(event)

    def _excess(self, frame: Frame) -> str:
        """Return which bound the frame exceeds; empty if it exceeds none."""
        if frame.opcode in CTRL_OPCODES:
            return "" if self._control.try_take(1) else "too many control frames"
        self._fragments = 0 if frame.fin else self._fragments + 1
        if self._fragments <= _MAX_FRAGMENTS:
            return ""
        return f"more than {_MAX_FRAGMENTS} fragments in a message"


def bounded_by(
    of_server: ConnectionLimit, wall_clock: WallClock
) -> type[BoundedConnection]:
    """Return the class of the connections of one server."""

    class Connection(BoundedConnection):
        limit, clock = of_server, wall_clock

    return Connection
