"""Run of a launch file, from the command line to the exit code."""

import os
import queue
import signal
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from navette.errors import FileFormatError
from navette.ros2.launch.arguments import (
    is_complete,
    unknown_argument_error,
    unknown_arguments,
)
from navette.ros2.launch.programs import InProcessRunner
from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.actions import IncludeLaunchDescription
from navette.ros2.packages.launch.actions.arguments import describe_arguments
from navette.ros2.packages.launch.events import Shutdown
from navette.ros2.packages.launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
)
from navette.ros2.packages.launch.logging import console, get_logger
from navette.ros2.packages.launch.running import Runner
from navette.ros2.packages.launch.subprocesses import SubprocessRunner
from navette.ros2.workspace import activate, find_package
from navette.ros2.workspace.finding import PATH_VARIABLE
from navette.supervisor import ProcessManager

_INTERRUPTED = 130
_log = get_logger("launch")


def find_launch_file(words: list[str]) -> tuple[Path, list[str]]:
    """Resolve ``FILE …`` or ``PACKAGE FILE …``; return the file and the other words.

    Raises:
        FileFormatError: the file does not exist.
        UnknownNameError: unknown package.
    """
    path = Path(words[0])
    if path.is_file():
        return path.resolve(), words[1:]
    if len(words) == 1 or ":=" in words[1]:
        raise FileFormatError(path, f"no such launch file{_listed(Path.cwd())}")
    share = find_package(words[0]).share
    found = [p for p in sorted(share.rglob(words[1])) if p.is_file()]
    if not found:
        raise FileFormatError(
            share, f"contains no launch file {words[1]!r}{_listed(share)}"
        )
    return found[0], words[2:]


def _listed(folder: Path) -> str:
    """List the launch files of a folder, for an error message."""
    places = (folder, folder / "launch")
    names = {
        str(path.relative_to(folder))
        for place in places
        for path in place.glob("*launch*.*")
        if path.suffix in (".py", ".xml", ".yaml", ".yml")
    }
    return f"; there is {', '.join(sorted(names))}" if names else ""


def show_arguments(path: Path) -> str:
    """Describe the arguments of a launch file and of the files that it includes."""
    with _workspace_of(path):
        activate()
        return describe_arguments(_load(_source(path)).get_launch_arguments())


def launch(
    path: Path,
    arguments: Mapping[str, str],
    *,
    processes: bool = False,
    manager: ProcessManager | None = None,
    debug: bool = False,
) -> int:
    """Run a launch file until everything that it started has ended.

    Args:
        path: the file: Python, XML or YAML.
        arguments: its launch arguments.
        processes: run each node in its own process.
        manager: starts these processes; implies ``processes``.
        debug: print debug messages.

    Returns:
        0; 1 if the launch or a process failed; 130 after Ctrl-C.

    Raises:
        NavetteError: an invalid file or argument.
    """
    with _workspace_of(path), console(debug=debug):
        activate()
        source = _source(path)
        description = _load(source)
        known = [each.name for each in description.get_launch_arguments()]
        unknown = unknown_arguments(arguments, known)
        if unknown and is_complete(description):
            raise unknown_argument_error(unknown[0], known)
        runner: Runner = (
            SubprocessRunner(manager) if processes or manager else InProcessRunner()
        )
        service = LaunchService(
            argv=[f"{name}:={value}" for name, value in arguments.items()],
            runner=runner,
        )
        if unknown:
            service.check_after_start(lambda: _check_again(service, arguments))
        # Set directly, so that the file can also read undeclared arguments.
        service.context.launch_configurations.update(arguments)
        service.include_launch_description(
            LaunchDescription([IncludeLaunchDescription(source)])
        )
        with _signals(service) as received:
            code = service.run() or int(bool(service.context.failed_labels))
        return _INTERRUPTED if received else code


def _source(path: Path) -> AnyLaunchDescriptionSource:
    return AnyLaunchDescriptionSource(path)


def _load(source: AnyLaunchDescriptionSource) -> LaunchDescription:
    loaded = source.try_get_launch_description_without_context()
    assert loaded is not None, "the path has no substitutions"
    return loaded


def _check_again(service: LaunchService, arguments: Mapping[str, str]) -> None:
    """Check the arguments after functions of the file had a chance to declare them."""
    known = sorted(service.context.known_arguments)
    for name in unknown_arguments(arguments, known):
        raise unknown_argument_error(name, known)


@contextmanager
def _workspace_of(path: Path) -> Iterator[None]:
    """Add the folder of the launch file's package to the search path of packages."""
    before = os.environ.get(PATH_VARIABLE)
    package = next((p for p in path.parents if (p / "package.xml").is_file()), None)
    if package is not None:
        parts = [part for part in (before, str(package.parent)) if part]
        os.environ[PATH_VARIABLE] = os.pathsep.join(parts)
    try:
        yield
    finally:
        if before is None:
            os.environ.pop(PATH_VARIABLE, None)
        else:
            os.environ[PATH_VARIABLE] = before


@contextmanager
def _signals(service: LaunchService) -> Iterator[list[int]]:
    """Shut the launch down on SIGINT and SIGTERM; escalate on further signals.

    The handler only queues: it may interrupt a holder of the loop's locks.
    """
    received: list[int] = []
    waiting: queue.SimpleQueue[int | None] = queue.SimpleQueue()

    def watch() -> None:
        while (number := waiting.get()) is not None:
            received.append(number)
            name = signal.Signals(number).name
            if len(received) == 1:
                _log.warning("%s: shutting down", name)
                sigint = number == signal.SIGINT
                service.emit_event(Shutdown(reason=name, due_to_sigint=sigint))
            else:
                service.escalate()

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    handlers = {
        number: signal.signal(number, lambda signum, frame: waiting.put(signum))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield received
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        waiting.put(None)
        watcher.join()
