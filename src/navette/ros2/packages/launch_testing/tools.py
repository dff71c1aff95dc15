"""Processes that a test starts and ends itself."""

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
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
from navette.ros2.packages.launch_testing.text_matching import (
    lines_match,
    text_matches,
    without_colours,
)

__all__ = [
    "ProcessProxy",
    "basic_output_filter",
    "expect_output",
    "expected_output_from_file",
    "launch_process",
]


_FILTERED_PREFIXES = ("pid", "rc")


def expect_output(
    text: str | None = None,
    *,
    lines: list[str] | None = None,
    expected_text: Any = None,
    expected_lines: Any = None,
    strip_ansi_escape_sequences: bool = True,
    strict: bool = False,
) -> bool:
    """Return whether output has the expected lines or text, ``strict``: only these.

    Raises:
        ValueError: both text and lines, or neither of them.
    """
    if (text is None) == (lines is None):
        raise ValueError("Either lines or text, but not both, must be specified")
    if (expected_text is None) == (expected_lines is None):
        raise ValueError(
            "Either expected lines or text, but not both, must be specified"
        )
    written = text if text is not None else "\n".join(lines or [])
    if strip_ansi_escape_sequences:
        written = without_colours(written)
    if expected_text is not None:
        return text_matches(written, expected_text, strict=strict)
    return lines_match(written.splitlines(), expected_lines, strict=strict)


def expected_output_from_file(path: str, encoding: str | None = None) -> list[Any]:
    """Return the lines of ``path.txt``, or the patterns of ``path.regex``.

    Raises:
        RuntimeError: neither of the files exists.
    """
    for suffix, kind in ((".txt", str), (".regex", re.compile)):
        file = Path(f"{path}{suffix}")
        if file.is_file():
            return [kind(line) for line in file.read_text(encoding).splitlines()]
    raise RuntimeError(f"could not find {path}.txt or {path}.regex")


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[Any] | None = None,
) -> Callable[[str], str]:
    """Return a function that removes lines by their start or by a pattern.

    Args:
        filtered_prefixes: default: ``pid`` and ``rc``.
    """
    prefixes = tuple(
        _FILTERED_PREFIXES if filtered_prefixes is None else filtered_prefixes
    )
    patterns = [re.compile(each) for each in filtered_patterns or ()]

    def remove(output: str) -> str:
        lines = output.splitlines(keepends=True)
        return "".join(
            line
            for line in lines
            if not line.startswith(prefixes)
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
        parts = [
            event.text
            for event in self._output
            if event.action is self.target_process_action
            and any(getattr(event, stream) for stream in streams)
        ]
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
