"""Listening sockets of the live view."""

import errno
import os
import socket
from collections.abc import Sequence
from contextlib import ExitStack

from navette.errors import InvalidValueError

_BACKLOG = 100
# Accepted connections inherit it: the server parses so many bytes without a pause.
_RECEIVE_BUFFER = 16 * 1024

Listeners = Sequence[socket.socket]


def listen(host: str, port: int) -> Listeners:
    """Listen on every address of a host, on one port.

    Clients may connect at once; they wait until a server accepts them.

    Args:
        host: name or address; empty listens on all networks.
        port: TCP port; 0 takes a free one.

    Raises:
        InvalidValueError: the port is in use or the address cannot be bound.
    """
    try:
        found = socket.getaddrinfo(
            host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )
        with ExitStack() as opened:
            listeners: list[socket.socket] = []
            for family, _, _, _, address in dict.fromkeys(found):
                listener = opened.enter_context(socket.socket(family))
                _bind(listener, (address[0], port, *address[2:]))
                port = port_of([listener])
                listeners.append(listener)
            opened.pop_all()
    except OSError as error:
        raise _explained(error, host, port) from error
    return listeners


def port_of(listeners: Listeners) -> int:
    return int(listeners[0].getsockname()[1])


def url_of(host: str, port: int, scheme: str = "http") -> str:
    """Return the address of the page on this machine."""
    if host in ("0.0.0.0", "::", ""):
        host = "127.0.0.1"
    return f"{scheme}://{f'[{host}]' if ':' in host else host}:{port}"


def _bind(listener: socket.socket, address: tuple[object, ...]) -> None:
    if os.name == "posix":  # on Windows it lets two programs share a port
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    if listener.family == socket.AF_INET6:
        listener.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER)
    listener.bind(address)
    listener.listen(_BACKLOG)


def _explained(error: OSError, host: str, port: int) -> InvalidValueError:
    where = f"viewer: cannot listen on {host} port {port}"
    if error.errno == errno.EADDRINUSE:
        return InvalidValueError(
            f"{where}: the port is in use; stop the program that uses it or choose "
            "another port"
        )
    return InvalidValueError(f"{where}: {error.strerror or error}")
