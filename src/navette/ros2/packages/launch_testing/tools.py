"""Processes that a test starts and ends itself."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Condition
from typing import Any

from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.actions import (
    ExecuteProcess,
    RegisterEventHandler,
    UnregisterEventHandler,
)
from navette.ros2.packages.launch.event_handlers import (
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
)
from navette.ros2.packages.launch.events import matches_action
from navette.ros2.packages.launch.events.process import ProcessExited, ShutdownProcess
from navette.ros2.packages.launch_testing.text_matching import make_matcher

__all__ = ["ProcessProxy", "basic_output_filter", "expect_output", "launch_process"]


def expect_output(
    *,
    expected_lines: list[Any] | None = None,
    expected_text: Any = None,
    text: str | None = None,
    lines: list[str] | None = None,
    strict: bool = False,
) -> bool:
    """Return whether output has the expected lines or text, ``strict``: only these."""
    written = text if text is not None else "\n".join(lines or [])
    expected = expected_text if expected_text is not None else expected_lines
    if strict and isinstance(expected, str):
        return written.split("\n") == expected.split("\n")
    if (
        strict
        and isinstance(expected, list)
        and all(isinstance(line, str) for line in expected)
    ):
        return written.splitlines() == expected
    return make_matcher(expected)(written)


def basic_output_filter(
    *, filtered_prefixes: list[str] | None = None, filtered_patterns: Any = None
) -> Callable[[str], str]:
    """Return a function that removes lines by their start or by a pattern."""
    prefixes = tuple(filtered_prefixes or ())
    patterns = list(filtered_patterns or ())

    def remove(output: str) -> str:
        lines = output.splitlines(keepends=True)
        return "".join(
            line
            for line in lines
            if not line.startswith(prefixes or ("\0",))
            and not any(pattern.match(line) for pattern in patterns)
        )

    return remove


class ProcessProxy:
    """A process under test: its output, its state, and waits for both."""

    def __init__(
        self,
        process_action: ExecuteProcess,
        proc_info: Any,
        proc_output: Any,
        *,
        output_filter: Callable[[str], str] | None = None,
    ) -> None:
        self.target_process_action = process_action
        self._info = proc_info
        self._output = proc_output
        self._filter = output_filter or (lambda text: text)

    def wait_for_shutdown(self, timeout: float | None = None) -> bool:
        """Return whether the process ends within ``timeout`` seconds."""
        changed: Condition = self._info.proc_event
        with changed:
            return changed.wait_for(lambda: self.terminated, timeout)

    def wait_for_output(
        self,
        condition: Callable[[str], bool] | None = None,
        timeout: float | None = None,
    ) -> bool:
        """Return whether the output fulfils a condition within ``timeout`` seconds.

        Args:
            condition: takes the whole output; default: any output.
        """
        changed: Condition = self._output.io_event
        holds = condition or bool
        with changed:
            return changed.wait_for(lambda: bool(holds(self.output)), timeout)

    def _text(self, *streams: str) -> str:
        if self.target_process_action not in self._output.processes():
            return ""
        events = self._output[self.target_process_action]
        parts = [e.text for e in events if any(getattr(e, s) for s in streams)]
        return self._filter(b"".join(parts).decode(errors="replace"))

    @property
    def stderr(self) -> str:
        return self._text("from_stderr")

    @property
    def stdout(self) -> str:
        return self._text("from_stdout")

    @property
    def output(self) -> str:
        return self._text("from_stdout", "from_stderr")

    @property
    def running(self) -> bool:
        known = self.target_process_action in self._info.processes()
        return known and not self.terminated

    @property
    def terminated(self) -> bool:
        return self.exit_code is not None

    @property
    def exit_code(self) -> int | None:
        """Code of the exit; None before."""
        if self.target_process_action not in self._info.processes():
            return None
        event = self._info[self.target_process_action]
        return event.returncode if isinstance(event, ProcessExited) else None


@contextmanager
def launch_process(
    launch_service: LaunchService,
    process_action: ExecuteProcess,
    proc_info: Any,
    proc_output: Any,
    **kwargs: Any,
) -> Iterator[ProcessProxy]:
    """Start a process in a launch that runs; end it after the block.

    Args:
        kwargs: of :class:`ProcessProxy`.
    """
    proxy = ProcessProxy(process_action, proc_info, proc_output, **kwargs)
    target, info, output = process_action, proc_info.append, proc_output.append
    handlers: list[Any] = [
        OnProcessStart(target_action=target, on_start=lambda event, _: info(event)),
        OnProcessExit(target_action=target, on_exit=lambda event, _: info(event)),
        OnProcessIO(target_action=target, on_stdout=output, on_stderr=output),
    ]
    launch_service.include_launch_description(
        LaunchDescription([*map(RegisterEventHandler, handlers), process_action])
    )
    try:
        yield proxy
    finally:
        matcher = matches_action(process_action)
        launch_service.emit_event(ShutdownProcess(process_matcher=matcher))
        proxy.wait_for_shutdown()
        launch_service.include_launch_description(
            LaunchDescription(list(map(UnregisterEventHandler, handlers)))
        )
