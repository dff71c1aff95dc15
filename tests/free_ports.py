"""TCP ports on the loopback interface for programs that are told where to listen.

The kernel gives a socket that asks for no port one of its own range (from 32768 on, on
Linux). If a test takes one from it for a program, it may be anybody's before the
program listens there, and two networks that should not meet are one. So these are of
another range.
"""

import itertools
import os
import socket

_FIRST, _COUNT = 10_000, 20_000
# Processes that test at the same time begin far from each other.
_numbers = itertools.count(509 * os.getpid())


def free_port() -> int:
    """One that nobody uses now, and that this process does not give again soon."""
    for number in itertools.islice(_numbers, _COUNT):
        port = _FIRST + number % _COUNT
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
            return port
    raise AssertionError(f"no free port from {_FIRST} to {_FIRST + _COUNT - 1}")


def free_endpoint() -> str:
    """The same, as Zenoh writes it."""
    return f"tcp/127.0.0.1:{free_port()}"
