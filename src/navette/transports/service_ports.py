"""The service half of the seam: requests from clients, replies from servers."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple


class RequestId(NamedTuple):
    """Whose request it is: a reply goes back to that client under that number.

    Others may use the same two, by mistake or on purpose: ``ticket`` says at the port
    that has taken a request which of those it is; 0 in process, where nobody can.
    """

    client_gid: bytes
    sequence: int
    ticket: int = 0


class Request(NamedTuple):
    """One request as a server gets it; stamps in nanoseconds."""

    message: Any
    source_ns: int
    received_ns: int
    id: RequestId


class Reply(NamedTuple):
    """One reply as the client gets it; without a message, why there is none.

    ``timed_out``: nobody answered in the time that the transport waits.
    """

    message: Any
    sequence: int
    failure: str = ""
    timed_out: bool = False


RequestSink = Callable[[Request], None]
"""Takes one request; must only queue it and return."""

ReplySink = Callable[[Reply], None]
"""Takes one reply; must only queue it and return."""


class ServicePort(ABC):
    """A server's door into a transport."""

    __slots__ = ()

    @abstractmethod
    def reply(self, request_id: RequestId, message: Any) -> None:
        """Send a reply as it is now; a client that has left is no error."""

    @abstractmethod
    def fail(self, request_id: RequestId, reason: str) -> None:
        """Tell the client that there will be no reply, and why."""

    @abstractmethod
    def close(self) -> None:
        """Leave the service; closing twice is harmless."""


class ClientPort(ABC):
    """A client's door into a transport."""

    __slots__ = ()

    @property
    def initial_sequence(self) -> int:
        """Last sequence number sent under this gid by an earlier client."""
        return 0

    @abstractmethod
    def request(self, message: Any, source_ns: int, sequence: int) -> None:
        """Send a request as it is now to every server that fits."""

    @property
    @abstractmethod
    def server_count(self) -> int:
        """How many servers the requests go to through this transport."""

    @abstractmethod
    def close(self) -> None:
        """Leave the service; closing twice is harmless."""
