"""Names of sessions by which Navette's know each other, and where each of them runs.

A session's id on the network is 16 bytes that may be chosen: a mark, the machine, the
process, and what makes it unique. Nobody else looks into them.
"""

import hashlib
import os
import secrets
from functools import cache
from pathlib import Path

_MARK = "6e617665"  # "nave"
_FIELD = 8  # hex digits of each of the four parts
# Of two peers the one with the greater id calls the other, as rmw_zenoh sets it; the
# last byte counts most. ROS 2's nodes listen on their own machine only: from another
# one they are reached if they call, so Navette's id is to be the smaller.
_LOW = "00"
_BOOT = Path("/proc/sys/kernel/random/boot_id")
# Where process ids mean the same, and where no link is cut.
_SPACES = Path("/proc/self/ns/pid"), Path("/proc/self/ns/net")


def new_zid() -> str:
    """Of a session of this process that takes part in the recovery."""
    unique = secrets.token_hex(_FIELD // 2 - len(_LOW) // 2)
    return f"{_MARK}{_host()}{os.getpid() % 2**32:08x}{unique}{_LOW}"


def is_kin(zid: str) -> bool:
    """Whether it is a session of Navette's."""
    return len(zid) == 4 * _FIELD and zid.startswith(_MARK)


def runs_beside(zid: str, other: str) -> bool:
    """Whether two of Navette's sessions run where their processes see each other."""
    if not (is_kin(zid) and is_kin(other)) or zid == other:
        return False
    return zid[_FIELD : 2 * _FIELD] == other[_FIELD : 2 * _FIELD]


def has_died(zid: str) -> bool:
    """Whether the process of the session is known to be gone; False: who knows.

    One whose link was lost may come back, one without a process never will.
    """
    if not is_kin(zid) or zid[_FIELD : 2 * _FIELD] != _host():
        return False
    pid = int(zid[2 * _FIELD : 3 * _FIELD], 16)
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    except (OSError, OverflowError):  # another user's, or nothing that could be asked
        return False
    return _is_zombie(pid)


def _is_zombie(pid: int) -> bool:
    """Ended, but its parent has not asked how yet."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_bytes()
    except OSError:
        return False
    return stat.rpartition(b")")[2].split()[:1] == [b"Z"]


@cache
def _host() -> str:
    """The same for processes that see each other, where the system tells of it."""
    try:
        parts = [_BOOT.read_text(), *(str(space.readlink()) for space in _SPACES)]
    except OSError:
        return secrets.token_hex(_FIELD // 2)  # then nobody is a neighbour
    # The name, too: copies of a virtual machine may have been started only once.
    place = "\n".join((*parts, os.uname().nodename))
    return hashlib.sha256(place.encode()).hexdigest()[:_FIELD]
