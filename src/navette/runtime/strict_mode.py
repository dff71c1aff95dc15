"""Strict mode: refuse what ROS 2 refuses although Navette can run it.

- An integer is not a value of a double parameter, nor an item of a list of doubles.
- Full names of topics and services have at most 247 characters.
- A callback does not wait for what only its own thread or group can deliver.
"""

import os

from navette.errors import NavetteError

#: ``navette run --strict`` sets it, also for processes that the program starts.
VARIABLE = "NAVETTE_STRICT"


class DeadlockError(NavetteError, RuntimeError):
    """A callback waits for what never arrives on ROS 2."""


def is_strict() -> bool:
    """Whether strict mode is on: the variable is set, and not 0."""
    return os.environ.get(VARIABLE, "0") not in ("", "0")


def enable() -> None:
    os.environ[VARIABLE] = "1"


def check_wait(
    what: str, *, in_driver_thread: bool, same_group: bool, exclusive: bool
) -> None:
    """Check a wait in strict mode.

    Args:
        what: the call, for the error.
        in_driver_thread: the caller is a callback in the thread of the executor.
        same_group: the awaited answer belongs to the group of the waiting callback.
        exclusive: that group is mutually exclusive.

    Raises:
        DeadlockError: the wait never ends on ROS 2.
    """
    if not is_strict():
        return
    if in_driver_thread:
        reason = "the executor has one thread, which the callback occupies"
    elif same_group and exclusive:
        reason = "client and callback share a mutually exclusive callback group"
    else:
        return
    raise DeadlockError(
        f"{what} in a callback waits forever on ROS 2: {reason}. Use call_async() with "
        "await or a done callback, or a MultiThreadedExecutor and a group of its own"
    )
