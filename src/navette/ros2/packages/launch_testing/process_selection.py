"""Selection of processes, and an action that keeps a launch running."""

from typing import Any

from navette.ros2.packages.launch import LaunchContext
from navette.ros2.packages.launch.actions import ExecuteLocal, OpaqueCoroutine
from navette.ros2.packages.launch.substitutions import TextSubstitution

__all__ = [
    "NO_CMD_ARGS",
    "KeepAliveProc",
    "NoMatchingProcessException",
    "resolveProcesses",
]

NO_CMD_ARGS = object()
"""In place of ``cmd_args``: the command line has no arguments."""


class NoMatchingProcessException(Exception):  # noqa: N818 - ROS 2's name
    """No process matches, or several do where one is expected."""


def KeepAliveProc() -> Any:  # noqa: N802 - ROS 2's name
    """Return an action that keeps the launch running until its shutdown."""

    async def wait() -> None:
        import asyncio

        await asyncio.Event().wait()

    return OpaqueCoroutine(coroutine=wait, ignore_context=True)


def resolveProcesses(  # noqa: N802 - ROS 2's name
    info_obj: Any,
    *,
    process: Any = None,
    cmd_args: Any = None,
    strict_proc_matching: bool = True,
) -> list[Any]:
    """Return the actions of the processes that are meant.

    Args:
        info_obj: object with ``processes()``, such as ``proc_info``.
        process: an action, a part of a process's name, or None for all processes.
        cmd_args: words that the command line has, for a process given by name; one
            word or a list; ``NO_CMD_ARGS``: there are none.
        strict_proc_matching: a name must match one process.

    Raises:
        NoMatchingProcessException: lists the processes.
    """
    known = list(info_obj.processes())
    if process is None:
        if not known:
            raise NoMatchingProcessException("No data recorded for any process")
        return known
    if isinstance(process, ExecuteLocal):
        if process not in known:
            raise NoMatchingProcessException(
                f"No data recorded for proc {_described(process)}"
            )
        return [process]
    if not isinstance(process, str):
        raise TypeError(f"process {process!r}: expected an action or a name")
    found = [
        each
        for each in known
        if process in each.process_details["name"] and _has_words(each, cmd_args)
    ]
    if found and (len(found) == 1 or not strict_proc_matching):
        return found
    problem = "Found multiple" if found else "Did not find any"
    raise NoMatchingProcessException(
        f"{problem} processes matching name {process!r} and cmd_args {cmd_args!r}. "
        f"Procs: {', '.join(sorted(map(_described, known))) or 'none'}"
    )


def _has_words(action: Any, wanted: Any) -> bool:
    words = action.process_details["cmd"]
    if wanted is NO_CMD_ARGS:
        return len(words) == 1
    given = [wanted] if isinstance(wanted, str) else wanted or ()
    return all(word in words[1:] for word in given)


def _described(action: Any) -> str:
    """Return the name and the command line of a process, as far as they are known."""
    details = action.process_details
    if details is not None:
        return f"{details['name']}: {' '.join(details['cmd'])}"
    words = action.process_description.cmd
    parts = [part for word in words for part in word]
    if not all(isinstance(part, TextSubstitution) for part in parts):
        return "Unknown - Process not launched yet"
    return " ".join(word.perform(LaunchContext()) for word in words)
