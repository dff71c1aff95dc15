"""TCP ports on the loopback interface for programs with a configured port.

The kernel assigns ephemeral ports (on Linux from 32768) to sockets bound to port 0.
Such a port could be assigned again before the program under test listens on it, and two
separate networks would be connected. These ports are outside that range.
"""

import itertools
import os
import socket

_FIRST, _COUNT = 10_000, 20_000
# Concurrent test processes start far from each other.
_numbers = itertools.count(509 * os.getpid())


def free_port() -> int:
    """Return an unused port that this process does not return again soon."""
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
    """Return a free port as a Zenoh endpoint."""
    return f"tcp/127.0.0.1:{free_port()}"
