"""Selection of processes, and an action that keeps a launch running."""

from typing import Any

from navette.ros2.packages.launch.actions import OpaqueCoroutine

__all__ = ["KeepAliveProc", "NoMatchingProcessException", "resolveProcesses"]


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
    cmd_args: str | None = None,
    strict_proc_matching: bool = True,
) -> list[Any]:
    """Return the actions of the processes that are meant.

    Args:
        info_obj: object with ``processes()``, such as ``proc_info``.
        process: an action, a part of a process's name, or None for all processes.
        cmd_args: a part of a word of the command line.
        strict_proc_matching: a name must match one process.

    Raises:
        NoMatchingProcessException: lists the processes.
    """
    known = list(info_obj.processes())
    if process is None:
        found = known
    elif isinstance(process, str):
        found = [each for each in known if process in each.process_details["name"]]
    else:
        found = [each for each in known if each is process]
    if cmd_args is not None:
        found = [each for each in found if _has_word(each, cmd_args)]
    names = ", ".join(each.process_details["name"] for each in known) or "none"
    if not found:
        shown = (
            process if isinstance(process, str) else getattr(process, "name", process)
        )
        raise NoMatchingProcessException(f"no process {shown!r}; processes: {names}")
    if isinstance(process, str) and strict_proc_matching and len(found) > 1:
        raise NoMatchingProcessException(
            f"process {process!r} matches {len(found)} processes; processes: {names}"
        )
    return found


def _has_word(action: Any, text: str) -> bool:
    return any(text in word for word in action.process_details["cmd"])
