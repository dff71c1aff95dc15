"""User of a connection from this machine, as the Linux kernel reports it.

``/proc/net/tcp`` and ``tcp6`` list the sockets of this network namespace with their
owners (man 5 proc). A connection from this machine has two entries; that of the other
end names the user whose program opened it.
"""

import ipaddress
import os
import sys
from pathlib import Path

_TABLES = (Path("/proc/net/tcp"), Path("/proc/net/tcp6"))
_ESTABLISHED = "01"
_ROOT = 0

Endpoint = tuple[str, int]
"""IP address and port."""


def user_of(client: Endpoint, server: Endpoint) -> int | None:
    """Return the user id of a client; None for another machine or a closed connection.

    On systems without these tables, the user of this process: there the users of a
    machine are not distinguished.
    """
    if not ipaddress.ip_address(client[0]).is_loopback:
        return None
    tables = [table for table in _TABLES if table.exists()]
    if not tables:
        return os.geteuid()
    for table in tables:
        owner = owner_of(client, server, table.read_text(encoding="ascii"))
        if owner is not None:
            return owner
    return None


def is_trusted(user: int | None) -> bool:
    """Whether a user is that of this process, or root."""
    return user in (os.geteuid(), _ROOT)


def owner_of(
    client: Endpoint, server: Endpoint, table: str, *, order: str = sys.byteorder
) -> int | None:
    """Return the user id of the client's socket; None if the table does not list it.

    Args:
        table: text of ``/proc/net/tcp`` or ``tcp6``.
        order: byte order of the machine that wrote the table.
    """
    for mapped in (False, True):
        ends = f"{_shown(client, mapped, order)} {_shown(server, mapped, order)}"
        begin = table.find(f" {ends} {_ESTABLISHED} ")
        if begin < 0:
            continue
        columns = table[begin:].split(maxsplit=9)
        # A socket without a process (inode 0) is listed under user 0.
        if len(columns) > 8 and columns[8] != "0":
            return int(columns[6])
    return None


def _shown(endpoint: Endpoint, mapped: bool, order: str) -> str:
    """Return an endpoint as the table prints it: words of the machine's byte order.

    Args:
        mapped: as an IPv4-mapped IPv6 address (``::ffff:127.0.0.1``).
    """
    address, port = endpoint
    octets = ipaddress.ip_address(address).packed
    if mapped:
        octets = b"\0" * 10 + b"\xff\xff" + octets[-4:]
    words = [octets[i : i + 4] for i in range(0, len(octets), 4)]
    if order == "little":
        words = [word[::-1] for word in words]
    return f"{b''.join(words).hex().upper()}:{port:04X}"
