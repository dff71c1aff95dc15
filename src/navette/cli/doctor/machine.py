"""Check this machine: versions, optional software, ports, orphaned programs."""

import ctypes
import importlib.metadata
import os
import platform
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from navette import __version__
from navette.cli.doctor.findings import Diagnosis, Rating
from navette.cli.doctor.graph_checks import NODES
from navette.cli.doctor.processes import Process, has_nodes, listener, processes
from navette.cli.doctor.router_diagnosis import PortProbe, probe

MACHINE = "This machine"
OLDEST_PYTHON = (3, 11)
VIEW_PORT = 8765

_GL_LIBRARIES = {"EGL": "libEGL.so.1", "OSMesa": "libOSMesa.so.8"}
# Processes that adopt orphans.
_INITS = {"systemd", "init", "launchd", "tini", "dumb-init", "docker-init"}
_BROWSERS = ("xdg-open", "open", "firefox", "chromium", "google-chrome")


def check_machine() -> Iterator[Diagnosis]:
    """Run the checks that do not need the network."""
    yield _versions()
    yield from _optional_parts()
    yield check_packages()
    yield _live_view()
    yield from left_running(processes(), os.getpid())


def _versions() -> Diagnosis:
    python = platform.python_version()
    zenoh = _version_of("eclipse-zenoh")
    data = {
        "navette": __version__,
        "python": python,
        "zenoh": zenoh,
        "platform": platform.platform(),
        "processors": os.cpu_count(),
    }
    text = (
        f"Navette {__version__}, Python {python}, Zenoh {zenoh or 'missing'},"
        f" {platform.system()} {platform.machine()}, {os.cpu_count()} processors"
    )
    if sys.version_info < OLDEST_PYTHON:
        oldest = ".".join(map(str, OLDEST_PYTHON))
        advice = f"Navette needs Python {oldest} or newer"
        return Diagnosis(Rating.PROBLEM, MACHINE, "versions", text, advice, data)
    if zenoh is None:
        advice = "pip install eclipse-zenoh, to communicate between processes"
        return Diagnosis(Rating.PROBLEM, MACHINE, "versions", text, advice, data)
    return Diagnosis(Rating.GOOD, MACHINE, "versions", text, data=data)


def _version_of(distribution: str) -> str | None:
    try:
        return importlib.metadata.version(distribution)
    except importlib.metadata.PackageNotFoundError:
        return None


def _optional_parts() -> Iterator[Diagnosis]:
    """Report software that is used if present; none of it is required."""
    from navette.ros2.names import installed_rclpy

    browser = next((name for name in _BROWSERS if shutil.which(name)), None)
    library = next((n for n, file in _GL_LIBRARIES.items() if _loads(file)), None)
    ros = installed_rclpy()
    for what, found, with_it, without in (
        ("browser", browser, f"{browser}", "none; open the live view elsewhere"),
        ("OpenGL", library, f"{library}", "none; cameras use ray casting instead"),
        ("ROS 2", ros, f"{ros}", "none; ROS 2 programs run on Navette"),
    ):
        level = Rating.GOOD if found else Rating.NOTE
        text = with_it if found else without
        yield Diagnosis(
            level, MACHINE, what, text, data={"found": str(found) if found else None}
        )


def check_packages() -> Diagnosis:
    """Report the packages of ROS 2 that programs use instead of Navette's."""
    from navette.ros2.names import replaced_packages

    replaced = {name: str(file.parent) for name, file in replaced_packages().items()}
    text = "packages that come with rclpy are Navette's"
    if replaced:
        used = ", ".join(f"{name} in {folder}" for name, folder in replaced.items())
        text = f"installed and used instead of Navette's: {used}"
    return Diagnosis(
        Rating.NOTE if replaced else Rating.GOOD,
        MACHINE,
        "packages",
        text,
        data={"replaced": replaced},
    )


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _live_view() -> Diagnosis:
    """Report the process on the live view's port."""
    what = f"port {VIEW_PORT}"
    if probe("127.0.0.1", VIEW_PORT) is not PortProbe.OPEN:
        return Diagnosis(Rating.NOTE, MACHINE, what, "free: no live view on this port")
    process = listener(VIEW_PORT)
    if process is None:
        return Diagnosis(Rating.NOTE, MACHINE, what, "in use")
    data = {"pid": process.pid, "command": process.command}
    text = f"in use by {process.command} (process {process.pid})"
    if is_navette(process):
        url = f"http://127.0.0.1:{VIEW_PORT}"
        text = f"live view at {url}, of {process.command} (process {process.pid})"
        return Diagnosis(Rating.GOOD, MACHINE, what, text, data=data)
    advice = "use another port for the live view: navette demo --port 8766"
    return Diagnosis(Rating.WARNING, MACHINE, what, text, advice, data)


def left_running(every: list[Process], here: int) -> Iterator[Diagnosis]:
    """Report Navette programs that lost their parent process.

    Args:
        every: all processes.
        here: id of this process.
    """
    by_id = {process.pid: process for process in every}
    for process in every:
        if process.pid == here or not is_navette(process):
            continue
        parent = by_id.get(process.parent)
        of_init = parent is not None and parent.command.partition(" ")[0] in _INITS
        # In a container, process 1 can be any program, also a shell.
        if of_init or (process.parent == 1 and process.session not in by_id):
            yield Diagnosis(
                Rating.WARNING,
                MACHINE,
                f"process {process.pid}",
                f"{process.command} still runs, but the terminal or program that"
                " started it has ended",
                f"if it is not needed: kill {process.pid}",
                {"pid": process.pid, "command": process.command},
            )


def stopped(every: list[Process], here: int) -> Iterator[Diagnosis]:
    """Report stopped programs with nodes: their nodes do not respond.

    Args:
        every: all processes.
        here: id of this process.
    """
    for process in every:
        if process.pid == here or not process.is_stopped:
            continue
        if has_nodes(process):
            yield Diagnosis(
                Rating.PROBLEM,
                NODES,
                f"process {process.pid}",
                f"{process.command} is stopped (Ctrl-Z, SIGSTOP): its nodes are frozen",
                f"continue it: fg in its terminal, or kill -CONT {process.pid}; or end"
                f" it: kill -KILL {process.pid}",
                {"pid": process.pid, "command": process.command},
            )


def is_navette(process: Process) -> bool:
    """Whether the process is the command ``navette`` or ``python -m navette``."""
    words = [word for word in process.words if word != "-u"][:3]
    names = [Path(word).name for word in words]
    is_python = bool(names) and names[0].startswith("python")
    return names[:1] == ["navette"] or (
        is_python and (names[1:2] == ["navette"] or words[1:] == ["-m", "navette"])
    )
