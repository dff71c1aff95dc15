"""Processes of this machine: who listens on a port, who is stopped, who uses Zenoh.

Processes of other users are only partly visible.
"""

import os
import shlex
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import psutil

from navette.files.runs import chosen_run, live_runs

_STOPPED = {psutil.STATUS_STOPPED, psutil.STATUS_TRACING_STOP}
# Programs that differ in one of these variables do not see each other.
_NETWORK_VARIABLES = ("ROS_DOMAIN_ID", "NAVETTE_ROUTER")


class Process(NamedTuple):
    """A running process.

    A stopped one (Ctrl-Z, SIGSTOP) keeps its ports but does not respond.
    """

    pid: int
    parent: int
    words: tuple[str, ...]
    is_stopped: bool = False
    session: int = 0

    @property
    def command(self) -> str:
        """The command line without interpreter and folders, quoted for a shell."""
        words = list(self.words)
        if words and Path(words[0]).name.startswith("python"):
            words = words[1:]
            while words[:1] in (["-u"], ["-I"], ["-P"], ["-s"]):
                words = words[1:]
        if words[:1] == ["-m"]:
            words = words[1:]
        if not words:
            return "?"
        program = Path(words[0]).name
        # A single word may be a title that the process has set.
        return shlex.join([program, *words[1:]]) if words[1:] else program


def processes() -> list[Process]:
    """Return all visible processes, sorted by id."""
    found = []
    for process in psutil.process_iter(["pid", "ppid", "cmdline", "status"]):
        info = process.info
        with suppress(OSError):  # the process has ended
            found.append(
                Process(
                    pid=info["pid"],
                    parent=info["ppid"] or 0,
                    words=tuple(info["cmdline"] or ()),
                    is_stopped=info["status"] in _STOPPED,
                    session=os.getsid(info["pid"]) if hasattr(os, "getsid") else 0,
                )
            )
    return sorted(found)


def listener(port: int) -> Process | None:
    """Return the process that listens on a TCP port; None if it is not visible."""
    pids: set[int | None] = set()
    with suppress(psutil.AccessDenied):
        pids = {
            each.pid
            for each in psutil.net_connections("tcp")
            if each.status == psutil.CONN_LISTEN and each.laddr.port == port
        }
    return next((each for each in processes() if each.pid in pids), None)


def has_zenoh(process: Process) -> bool | None:
    """Whether the process has loaded Zenoh; None if its memory map is not visible."""
    if "zenoh" in process.command:
        return True
    with suppress(psutil.Error, OSError, AttributeError):  # not on every system
        maps = psutil.Process(process.pid).memory_maps()
        return any("zenoh" in each.path for each in maps) if maps else None
    return None


def environment(process: Process) -> dict[str, str]:
    """Return the environment of the process at its start; empty if not visible."""
    with suppress(psutil.Error, OSError):
        return dict(psutil.Process(process.pid).environ())
    return {}


def has_nodes(process: Process) -> bool:
    """Whether the process uses Zenoh in the same network as this one."""
    run = chosen_run()
    theirs = _folders_of_sockets(process)
    if run is not None:
        return run.folder in theirs
    if any(each.folder in theirs for each in live_runs()):
        return False
    variables = environment(process)
    return bool(has_zenoh(process)) and all(
        variables.get(name) == os.environ.get(name) for name in _NETWORK_VARIABLES
    )


def _folders_of_sockets(process: Process) -> set[Path]:
    """Return the folders of the Unix sockets on which the process listens."""
    with suppress(psutil.Error, OSError):
        ends = psutil.Process(process.pid).net_connections("unix")
        return {Path(each.laddr).parent for each in ends if each.laddr}
    return set()
