"""Lines, exit codes and termination, without processes."""

import signal

import pytest

from navette.runtime import VirtualClock
from navette.runtime.loop import EventLoop
from navette.supervisor import GracePeriods, LineSplitter, describe_exit
from navette.supervisor.terminator import Terminator


def test_lines_are_split_as_they_arrive() -> None:
    splitter = LineSplitter()
    assert splitter.feed(b"one\r\ntw") == ["one"]
    assert splitter.feed(b"o\n\n") == ["two", ""]
    assert splitter.finish() == []
    assert splitter.feed(b"th\xff") == []
    assert splitter.finish() == ["th\N{REPLACEMENT CHARACTER}"]


def test_a_very_long_line_is_split() -> None:
    splitter = LineSplitter()
    assert splitter.feed(b"x" * (1 << 20)) == []
    assert len(splitter.feed(b"x")[0]) == (1 << 20) + 1


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
def test_exit_codes_in_words(code: int, words: str) -> None:
    assert describe_exit(code) == words


class FakeTarget:
    """Records what a terminator sends."""

    label = "rock"

    def __init__(self, loop: EventLoop) -> None:
        self.loop = loop
        self.signals: list[tuple[float, int]] = []
        self.escalations: list[str] = []

    def signal(self, number: int) -> None:
        self.signals.append((self.loop.clock.now_ns / 1e9, number))

    def on_escalated(self, signal_name: str) -> None:
        self.escalations.append(signal_name)


def test_signals_escalate_after_their_grace_periods() -> None:
    loop = EventLoop(VirtualClock())
    target = FakeTarget(loop)
    terminator = Terminator(GracePeriods(3.0, 4.0), target, loop)
    terminator.send_next()
    loop.run(until_ns=20_000_000_000)
    assert target.signals == [
        (0.0, signal.SIGINT),
        (3.0, signal.SIGTERM),
        (7.0, signal.SIGKILL),
    ]
    assert target.escalations == ["SIGTERM", "SIGKILL"]
    terminator.send_next()
    assert target.signals[-1] == (20.0, signal.SIGKILL)


def test_a_cancelled_termination_sends_no_more_signals() -> None:
    loop = EventLoop(VirtualClock())
    target = FakeTarget(loop)
    terminator = Terminator(GracePeriods(), target, loop)
    terminator.send_next()
    terminator.cancel()
    loop.run(until_ns=20_000_000_000)
    assert target.signals == [(0.0, signal.SIGINT)]
