"""Assertions about the output and the exit codes of processes."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from navette.ros2.packages.launch.events.process import ProcessExited
from navette.ros2.packages.launch_testing.process_selection import (
    NO_CMD_ARGS,
    NoMatchingProcessException,
    resolveProcesses,
)
from navette.ros2.packages.launch_testing.text_matching import (
    make_matcher,
    without_colours,
)

__all__ = [
    "EXIT_FORCED",
    "EXIT_OK",
    "EXIT_SIGINT",
    "EXIT_SIGKILL",
    "EXIT_SIGQUIT",
    "EXIT_SIGSEGV",
    "NO_CMD_ARGS",
    "NoMatchingProcessException",
    "SequentialTextChecker",
    "assertExitCodes",
    "assertInStderr",
    "assertInStdout",
    "assertInStream",
    "assertSequentialStdout",
]

EXIT_OK, EXIT_FORCED = 0, 1
EXIT_SIGINT, EXIT_SIGQUIT, EXIT_SIGKILL, EXIT_SIGSEGV = 130, 131, 137, 139

_STREAMS = {"stdout": "from_stdout", "stderr": "from_stderr"}


def assertExitCodes(  # noqa: N802 - ROS 2's name
    proc_info: Any,
    allowable_exit_codes: Sequence[int] = (EXIT_OK,),
    process: Any = None,
    cmd_args: Any = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Fail if a process ended with another code.

    Args:
        process: see :func:`resolveProcesses`; default: all processes.
    """
    for code in allowable_exit_codes:
        assert isinstance(code, int), f"exit code {code!r}: expected an integer"
    by_action = {event.action: event for event in proc_info}
    found = list(by_action)
    if process is not None:
        found = resolveProcesses(
            proc_info,
            process=process,
            cmd_args=cmd_args,
            strict_proc_matching=strict_proc_matching,
        )
    for event in (by_action[action] for action in found):
        assert isinstance(event, ProcessExited), f"{event.process_name} still runs"
        assert event.returncode in allowable_exit_codes, (
            f"{event.process_name} ended with code {event.returncode}; allowed: "
            f"{', '.join(map(str, allowable_exit_codes))}"
        )


def assertInStream(  # noqa: N802 - ROS 2's name
    proc_output: Any,
    expected_output: Any,
    process: Any,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = "stderr",
) -> None:
    """Fail if no process wrote the expected output to a stream.

    Args:
        expected_output: see :func:`make_matcher`.
        process: see :func:`resolveProcesses`.
        output_filter: applied to the output before the search.
    """
    is_found = make_matcher(expected_output)
    found = resolveProcesses(
        proc_output,
        process=process,
        cmd_args=cmd_args,
        strict_proc_matching=strict_proc_matching,
    )
    for action in found:
        text = _text(proc_output, action, stream)
        if strip_ansi_escape_sequences:
            text = without_colours(text)
        if is_found(text if output_filter is None else output_filter(text)):
            return
    names = ", ".join(action.process_details["name"] for action in found)
    raise AssertionError(f"{expected_output!r} not found in {stream} of {names}")


def assertInStdout(  # noqa: N802 - ROS 2's name
    proc_output: Any, expected_output: Any, process: Any, *args: Any, **kwargs: Any
) -> None:
    """Fail if no process wrote the expected output to its standard output."""
    kwargs["stream"] = "stdout"
    assertInStream(proc_output, expected_output, process, *args, **kwargs)


def assertInStderr(  # noqa: N802 - ROS 2's name
    proc_output: Any, expected_output: Any, process: Any, *args: Any, **kwargs: Any
) -> None:
    """Fail if no process wrote the expected output to its standard error."""
    kwargs["stream"] = "stderr"
    assertInStream(proc_output, expected_output, process, *args, **kwargs)


def _text(proc_output: Any, action: Any, stream: str) -> str:
    is_of_stream = _STREAMS[stream]
    events = proc_output[action]
    parts = [event.text for event in events if getattr(event, is_of_stream)]
    return b"".join(parts).decode(errors="replace")


class SequentialTextChecker:
    """Finds texts one after another, each behind the one before.

    Args:
        output: pieces of output, or one text.
    """

    def __init__(self, output: Iterable[str]) -> None:
        self._output = "".join(output)
        self._position = 0

    def assertInText(self, msg: Any) -> bool:  # noqa: N802 - ROS 2's name
        """Fail if the text is not found behind the one before."""
        return self.assertInStdout(msg)

    def assertInStdout(self, msg: Any) -> bool:  # noqa: N802 - ROS 2's name
        """Fail if the text is not found behind the one before.

        Args:
            msg: a text or a compiled pattern.
        """
        pattern = re.compile(re.escape(msg)) if isinstance(msg, str) else msg
        found = pattern.search(self._output, self._position)
        if found is None:
            raise AssertionError(
                f"{msg!r} not found after these lines:\n{self.get_nearby_lines()}"
            )
        self._position = found.end()
        return True

    def get_nearby_lines(self) -> str:
        """Return the current line, and two lines before and after it."""
        lines = self._output.splitlines()
        # Behind a whole line, the next one is the current line.
        at = self._output.count("\n", 0, self._position + 1)
        return "\n".join(lines[max(at - 2, 0) : at + 3])


@contextmanager
def assertSequentialStdout(  # noqa: N802 - ROS 2's name
    proc_output: Any, process: Any, cmd_args: Any = None
) -> Iterator[SequentialTextChecker]:
    """Provide a checker of the order of a process's standard output."""
    action = resolveProcesses(proc_output, process=process, cmd_args=cmd_args)[0]
    yield SequentialTextChecker([_text(proc_output, action, "stdout")])
