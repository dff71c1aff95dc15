"""Ctrl-C and SIGTERM: noticed in waits, silent while loading, never lost."""

import signal
import threading
from collections.abc import Callable, Iterator

import click
import pytest

from navette.cli import interruption
from navette.cli.commands import LazyGroup
from navette.cli.interruption import (
    default_signal_action,
    ending_on_signals,
    interruptible,
    obey_interrupts,
    raise_at_interrupt,
)
from navette.cli.verbs import VERBS

Condition = Callable[[], bool]


@pytest.fixture(autouse=True)
def _handlers_as_before() -> Iterator[None]:
    before = {s: signal.getsignal(s) for s in (signal.SIGINT, signal.SIGTERM)}
    yield
    for each, handler in before.items():
        signal.signal(each, handler)


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)]
)
def test_a_wait_ends_between_two_events(number: int, code: int) -> None:
    woken = threading.Event()
    seen = []

    def run(is_interrupted: Condition) -> None:
        signal.raise_signal(number)
        seen.append("the event under way is finished")
        assert woken.wait(60.0)
        assert is_interrupted()

    with pytest.raises(click.exceptions.Exit) as ended, ending_on_signals():
        interruptible(run, woken.set)
    assert ended.value.exit_code == code
    assert seen


def test_outside_of_waits_a_signal_raises_at_once() -> None:
    def body() -> None:
        signal.raise_signal(signal.SIGINT)
        pytest.fail("went on")

    with pytest.raises(click.exceptions.Exit) as ended, ending_on_signals():
        body()
    assert ended.value.exit_code == 130


def test_a_verb_may_clean_up_and_wait_for_that() -> None:
    cleaned = []

    def run(is_interrupted: Condition) -> None:
        signal.raise_signal(signal.SIGINT)

    def body() -> None:
        try:
            interruptible(run, lambda: None)
        except KeyboardInterrupt:
            interruptible(lambda asked: cleaned.append(asked()), lambda: None)
            raise

    with pytest.raises(click.exceptions.Exit), ending_on_signals():
        body()
    assert cleaned == [False]


def test_an_event_that_does_not_end_is_given_up(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    gone = threading.Event()
    codes = []

    def leave(code: int) -> None:
        codes.append(code)
        gone.set()

    monkeypatch.setattr(interruption, "_GRACE_PERIOD_S", 0.0)
    monkeypatch.setattr("os._exit", leave)

    def run(is_interrupted: Condition) -> None:
        signal.raise_signal(signal.SIGINT)
        assert gone.wait(60.0)

    with pytest.raises(click.exceptions.Exit), ending_on_signals():
        interruptible(run, lambda: None)
    assert codes == [130]


def test_ignored_signals_stay_ignored() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with default_signal_action(), ending_on_signals():
        signal.raise_signal(signal.SIGINT)
    raise_at_interrupt()
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_a_verb_that_a_script_started_in_the_background_ends_on_sigint() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    obey_interrupts()
    assert signal.getsignal(signal.SIGINT) is signal.SIG_DFL
    signal.signal(signal.SIGINT, signal.default_int_handler)
    obey_interrupts()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize(
    ("verb", "handler"),
    [("bag", signal.default_int_handler), ("topic", signal.SIG_DFL)],
)
def test_verbs_that_need_cleanup_get_keyboard_interrupt(
    verb: str, handler: object
) -> None:
    group = LazyGroup("navette", commands=list(VERBS))
    with default_signal_action():
        assert signal.getsignal(signal.SIGINT) is signal.SIG_DFL
        group.resolve_command(click.Context(group), [verb])
        assert signal.getsignal(signal.SIGINT) is handler
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
