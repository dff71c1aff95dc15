"""Ports of servers and clients: requests and replies of services."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple


class RequestId(NamedTuple):
    """Identifies a request, so that the reply reaches its client.

    Other clients may use the same gid and number, by mistake or on purpose. ``ticket``
    is unique at the port that accepted the request; it is 0 in process.
    """

    client_gid: bytes
    sequence: int
    ticket: int = 0


class Request(NamedTuple):
    """One request as a server receives it; stamps in nanoseconds."""

    message: Any
    source_ns: int
    received_ns: int
    id: RequestId


class Reply(NamedTuple):
    """One reply as the client receives it.

    Attributes:
        message: None if the request failed.
        failure: why there is no message.
        timed_out: whether no server replied within the transport's timeout.
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
    """Port of one server on a transport."""

    @abstractmethod
    def reply(self, request_id: RequestId, message: Any) -> None:
        """Send a reply as it is now; it is dropped if the client has closed."""

    @abstractmethod
    def fail(self, request_id: RequestId, reason: str) -> None:
        """Report to the client that there will be no reply."""

    @abstractmethod
    def close(self) -> None:
        """Leave the service; may be called again."""


class ClientPort(ABC):
    """Port of one client on a transport."""

    @property
    def initial_sequence(self) -> int:
        """Last sequence number sent under this gid by an earlier client."""
        return 0

    @abstractmethod
    def request(self, message: Any, source_ns: int, sequence: int) -> None:
        """Send a request as it is now to every matched server."""

    @property
    @abstractmethod
    def server_count(self) -> int:
        """Number of servers that receive the requests through this transport."""

    @abstractmethod
    def close(self) -> None:
        """Leave the service; may be called again."""
