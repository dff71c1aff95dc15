"""Which program listens on a port, as far as the system tells without rights.

Linux only (proc(5), tcp(7)): elsewhere the port is known to be in use, not by whom.
"""

import contextlib
import os
import socket
from enum import Enum
from pathlib import Path
from typing import NamedTuple

_PROC = Path("/proc")
_LISTEN = "0A"
_STOPPED = {"T", "t"}
# Programs that differ in one of these do not meet, or not in the same place.
_MEETING = ("ROS_DOMAIN_ID", "NAVETTE_ROUTER")


class Process(NamedTuple):
    """A running program: id, that of its parent, command line, id of its session.

    A stopped one (Ctrl-Z, SIGSTOP) keeps its ports, and answers nobody.
    """

    pid: int
    parent: int
    words: tuple[str, ...]
    is_stopped: bool = False
    session: int = 0

    @property
    def command(self) -> str:
        """The command as a person knows it, without interpreter and folders."""
        words = list(self.words)
        if words and Path(words[0]).name.startswith("python"):
            words = words[1:]
            while words[:1] in (["-u"], ["-I"], ["-P"], ["-s"]):
                words = words[1:]
        if words[:1] == ["-m"]:
            words = words[1:]
        return " ".join([Path(words[0]).name, *words[1:]]) if words else "?"


class PortProbe(Enum):
    """What comes of a TCP connection."""

    OPEN = "open"
    REFUSED = "refused"
    TIMED_OUT = "silent"
    UNREACHABLE = "no way there"
    UNKNOWN_HOST = "no such name"


def probe(host: str, port: int, timeout_s: float = 0.2) -> PortProbe:
    """Try whether somebody accepts connections there."""
    try:
        with socket.create_connection((host, port), timeout_s):
            return PortProbe.OPEN
    except socket.gaierror:
        return PortProbe.UNKNOWN_HOST
    except TimeoutError:
        return PortProbe.TIMED_OUT
    except ConnectionRefusedError:
        return PortProbe.REFUSED
    except OSError:
        return PortProbe.UNREACHABLE


def listener(port: int) -> Process | None:
    """The program that listens on a TCP port here; None if that cannot be told."""
    sockets = _listening_sockets(port)
    if not sockets:
        return None
    for process in processes():
        if sockets & _sockets_of(process.pid):
            return process
    return None


def processes() -> list[Process]:
    """All that can be seen, by id; empty where there is no /proc."""
    found = []
    for folder in _PROC.glob("[0-9]*"):
        # A process may end while one looks.
        with contextlib.suppress(OSError, ValueError):
            words = (folder / "cmdline").read_bytes().decode(errors="replace")
            stat = (folder / "stat").read_text(errors="replace")
            state, parent, _, session = stat.rpartition(")")[2].split()[:4]
            found.append(
                Process(
                    pid=int(folder.name),
                    parent=int(parent),
                    words=tuple(words.rstrip("\0").split("\0")),
                    is_stopped=state in _STOPPED,
                    session=int(session),
                )
            )
    return sorted(found)


def has_zenoh(process: Process) -> bool | None:
    """Whether a program has Zenoh in it; None: that cannot be seen."""
    with contextlib.suppress(OSError):
        folder = _PROC / str(process.pid)
        # Part of the program itself in zenohd, a library in all others.
        return (
            "zenoh" in (folder / "maps").read_text(errors="replace")
            or "zenoh" in process.command
        )
    return None


def environment(process: Process) -> dict[str, str]:
    """As the program was started with; empty where it cannot be seen."""
    with contextlib.suppress(OSError):
        entries = (_PROC / str(process.pid) / "environ").read_bytes()
        lines = entries.decode(errors="replace").split("\0")
        return dict(line.partition("=")[::2] for line in lines if "=" in line)
    return {}


def has_nodes(process: Process) -> bool:
    """Whether a program is on a network, and set to meet those started here."""
    theirs = environment(process)
    return bool(has_zenoh(process)) and all(
        theirs.get(name) == os.environ.get(name) for name in _MEETING
    )


def _listening_sockets(port: int) -> set[str]:
    """Inodes of the sockets that listen on a port."""
    found = set()
    for table in ("tcp", "tcp6"):
        with contextlib.suppress(OSError):
            for line in (_PROC / "net" / table).read_text().splitlines()[1:]:
                fields = line.split()
                if fields[3] == _LISTEN and int(fields[1].split(":")[1], 16) == port:
                    found.add(fields[9])
    return found


def _sockets_of(pid: int) -> set[str]:
    found = set()
    with contextlib.suppress(OSError):
        for link in (_PROC / str(pid) / "fd").iterdir():
            with contextlib.suppress(OSError):
                target = str(link.readlink())
                if target.startswith("socket:["):
                    found.add(target[8:-1])
    return found
