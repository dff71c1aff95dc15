"""Waits for the start, the exit and the output of processes.

Each function exists for coroutines and, with ``_sync``, for plain tests. The first
arguments are the fixture ``launch_context`` and the action of the process.
"""

import asyncio
from collections.abc import Callable
from threading import Condition
from typing import Any

from navette.ros2.packages.launch import LaunchContext
from navette.ros2.packages.launch.actions import ExecuteLocal
from navette.ros2.packages.launch.event_handler import CallbackHandler
from navette.ros2.packages.launch.events.process import RunningProcessEvent

__all__ = [
    "assert_output",
    "assert_output_sync",
    "assert_stderr",
    "assert_stderr_sync",
    "wait_for_exit",
    "wait_for_exit_sync",
    "wait_for_output",
    "wait_for_output_sync",
    "wait_for_start",
    "wait_for_start_sync",
    "wait_for_stderr",
    "wait_for_stderr_sync",
]

Validation = Callable[[str], Any]


def _wait_for(
    context: LaunchContext, holds: Callable[[], bool], timeout: float | None
) -> bool:
    """Wait until a condition holds; it is checked after each event of a process."""
    changed = Condition()

    def notify(event: Any, context: LaunchContext) -> None:
        with changed:
            changed.notify_all()

    handler = CallbackHandler(
        matcher=lambda event: isinstance(event, RunningProcessEvent), callback=notify
    )
    context.register_event_handler(handler, append=True)
    try:
        with changed:
            return changed.wait_for(holds, timeout)
    finally:
        context.unregister_event_handler(handler)


def wait_for_start_sync(
    launch_context: LaunchContext, process_action: ExecuteLocal, timeout: Any = None
) -> bool:
    """Return whether the process starts within ``timeout`` seconds."""
    return _wait_for(
        launch_context, lambda: process_action.process_details is not None, timeout
    )


def wait_for_exit_sync(
    launch_context: LaunchContext, process_action: ExecuteLocal, timeout: Any = None
) -> bool:
    """Return whether the process exits within ``timeout`` seconds."""
    return _wait_for(
        launch_context, lambda: process_action.return_code is not None, timeout
    )


def _is_valid(validate: Validation, text: str) -> bool:
    try:
        return validate(text) is not False
    except AssertionError:
        return False


def wait_for_output_sync(
    launch_context: LaunchContext,
    process_action: ExecuteLocal,
    validate_output: Validation,
    timeout: float | None = None,
) -> bool:
    """Return whether the standard output becomes valid within ``timeout`` seconds.

    Args:
        process_action: an action with ``cached_output=True``.
        validate_output: returns False or fails an assertion for invalid output.
    """
    return _wait_for(
        launch_context,
        lambda: _is_valid(validate_output, process_action.get_stdout()),
        timeout,
    )


def wait_for_stderr_sync(
    launch_context: LaunchContext,
    process_action: ExecuteLocal,
    validate_output: Validation,
    timeout: float | None = None,
) -> bool:
    """Return whether the standard error becomes valid within ``timeout`` seconds."""
    return _wait_for(
        launch_context,
        lambda: _is_valid(validate_output, process_action.get_stderr()),
        timeout,
    )


def assert_output_sync(
    launch_context: LaunchContext,
    process_action: ExecuteLocal,
    validate_output: Validation,
    timeout: float | None = None,
) -> None:
    """Fail if the standard output does not become valid within ``timeout`` seconds."""
    if not wait_for_output_sync(
        launch_context, process_action, validate_output, timeout
    ):
        _fail(validate_output, process_action.get_stdout())


def assert_stderr_sync(
    launch_context: LaunchContext,
    process_action: ExecuteLocal,
    validate_output: Validation,
    timeout: float | None = None,
) -> None:
    """Fail if the standard error does not become valid within ``timeout`` seconds."""
    if not wait_for_stderr_sync(
        launch_context, process_action, validate_output, timeout
    ):
        _fail(validate_output, process_action.get_stderr())


def _fail(validate: Validation, text: str) -> None:
    validate(text)  # the assertion that fails explains more
    raise AssertionError(f"the output is not valid: {text!r}")


async def wait_for_start(*args: Any, **kwargs: Any) -> bool:
    return await asyncio.to_thread(wait_for_start_sync, *args, **kwargs)


async def wait_for_exit(*args: Any, **kwargs: Any) -> bool:
    return await asyncio.to_thread(wait_for_exit_sync, *args, **kwargs)


async def wait_for_output(*args: Any, **kwargs: Any) -> bool:
    return await asyncio.to_thread(wait_for_output_sync, *args, **kwargs)


async def wait_for_stderr(*args: Any, **kwargs: Any) -> bool:
    return await asyncio.to_thread(wait_for_stderr_sync, *args, **kwargs)


async def assert_output(*args: Any, **kwargs: Any) -> None:
    await asyncio.to_thread(assert_output_sync, *args, **kwargs)


async def assert_stderr(*args: Any, **kwargs: Any) -> None:
    await asyncio.to_thread(assert_stderr_sync, *args, **kwargs)
