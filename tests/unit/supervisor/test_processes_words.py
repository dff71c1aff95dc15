"""Lines, exits, and the order of signals: no process is needed."""

import signal
from collections.abc import Callable
from dataclasses import dataclass

import pytest

from navette.supervisor import Ending, LineCutter, Patience, describe_exit


def test_lines_are_cut_as_they_come() -> None:
    cutter = LineCutter()
    assert cutter.feed(b"one\r\ntw") == ["one"]
    assert cutter.feed(b"o\n\n") == ["two", ""]
    assert cutter.finish() == []
    assert cutter.feed(b"th\xff") == []
    assert cutter.finish() == ["th\N{REPLACEMENT CHARACTER}"]


def test_an_endless_line_is_cut() -> None:
    cutter = LineCutter()
    assert cutter.feed(b"x" * (1 << 20)) == []
    assert len(cutter.feed(b"x")[0]) == (1 << 20) + 1


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (0, "ended"),
        (3, "exit code 3"),
        (-11, "killed by SIGSEGV"),
        (130, "exit code 130 (SIGINT)"),
        (-200, "exit code -200"),
        (255, "exit code 255"),
    ],
)
def test_exits_in_words(code: int, words: str) -> None:
    assert describe_exit(code) == words


@dataclass
class Later:
    """A call that a test makes itself."""

    seconds: float
    function: Callable[[], None]
    cancelled: bool = False

    def cancel(self) -> None:
        self.cancelled = True


def test_signals_grow_in_force() -> None:
    sent: list[int] = []
    forced: list[str] = []
    calls: list[Later] = []

    def later(seconds: float, function: Callable[[], None]) -> Later:
        calls.append(Later(seconds, function))
        return calls[-1]

    ending = Ending(Patience(3.0, 4.0), sent.append, later, forced.append)
    assert not ending.has_begun
    ending.go_on()
    assert ending.has_begun
    calls[0].function()
    calls[1].function()
    assert sent == [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]
    assert forced == ["SIGTERM", "SIGKILL"]
    assert [call.seconds for call in calls] == [3.0, 4.0]
    ending.go_on()
    assert sent[-1] == signal.SIGKILL


def test_an_end_cancels_what_would_come() -> None:
    calls: list[Later] = []

    def later(seconds: float, function: Callable[[], None]) -> Later:
        calls.append(Later(seconds, function))
        return calls[-1]

    ending = Ending(Patience(), lambda number: None, later, lambda name: None)
    ending.go_on()
    ending.cancel()
    assert calls[0].cancelled
