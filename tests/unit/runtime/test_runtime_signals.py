"""SIGTERM and its handlers."""

import contextvars
import signal
import subprocess
import sys
import textwrap
import threading
from collections.abc import Iterator

import pytest

import navette
from navette.runtime import SignalHandlerOptions, VirtualClock
from navette.runtime.context import (
    Scope,
    current_scope,
    get_default_context,
    reset_default_context,
)
from navette.runtime.signals import (
    get_current_signal_handlers_options,
    install_signal_handlers,
    uninstall_signal_handlers,
)


@pytest.fixture(autouse=True)
def fresh_default_context() -> Iterator[None]:
    reset_default_context()
    # A shutdown by another thread cannot remove the handler (a rule of Python).
    uninstall_signal_handlers()
    yield
    get_default_context().try_shutdown()
    uninstall_signal_handlers()
    reset_default_context()


def test_init_installs_and_shutdown_removes() -> None:
    before = signal.getsignal(signal.SIGTERM)
    navette.init(args=[], clock=VirtualClock())
    assert get_current_signal_handlers_options() is SignalHandlerOptions.ALL
    navette.shutdown()
    assert get_current_signal_handlers_options() is SignalHandlerOptions.NO
    assert signal.getsignal(signal.SIGTERM) is before


def test_a_background_job_ends_on_sigint() -> None:
    """As in rclpy, although shells start the jobs of a script with SIGINT ignored."""
    program = textwrap.dedent(
        """
        import signal
        import navette

        signal.signal(signal.SIGINT, signal.SIG_IGN)
        navette.init()
        node = navette.Node("job")
        node.create_timer(0.01, lambda: signal.raise_signal(signal.SIGINT))
        try:
            navette.spin(node)
        except KeyboardInterrupt:
            print("interrupted")
        """
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stdout) == (0, "interrupted\n"), done.stderr


def test_without_the_option_an_ignored_sigint_stays_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        install_signal_handlers(SignalHandlerOptions.SIGTERM)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
        install_signal_handlers(SignalHandlerOptions.SIGINT)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_custom_context_installs_the_given_handlers_only() -> None:
    context = navette.Context()
    with navette.init(args=[], context=context, clock=VirtualClock()):
        assert get_current_signal_handlers_options() is SignalHandlerOptions.NO
    navette.init(args=[], signal_handler_options=SignalHandlerOptions.SIGINT)
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    assert get_current_signal_handlers_options() is SignalHandlerOptions.SIGINT


def test_handlers_of_the_program_stay() -> None:
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        install_signal_handlers()
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
        uninstall_signal_handlers()
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGTERM, before)


def test_sigterm_ends_a_program_that_another_thread_has_shut_down(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before = signal.getsignal(signal.SIGTERM)
    alone = current_scope.set(Scope())
    context_of_thread = contextvars.copy_context()
    try:
        navette.init(args=[], clock=VirtualClock())
        thread = threading.Thread(target=context_of_thread.run, args=[navette.shutdown])
        thread.start()
        thread.join()
        assert not navette.ok()
        _sigterm_reaches_the_program(monkeypatch)
    finally:
        current_scope.reset(alone)
    assert signal.getsignal(signal.SIGTERM) is before


def _sigterm_reaches_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    left = signal.getsignal(signal.SIGTERM)
    assert callable(left)
    ends: list[int] = []
    monkeypatch.setattr(signal, "raise_signal", ends.append)
    left(signal.SIGTERM, None)
    assert ends == [signal.SIGTERM]


def test_sigterm_ends_the_spin_and_the_program_continues() -> None:
    program = """
        import navette, os, signal
        navette.init(args=[])
        node = navette.Node("n")
        node.create_timer(0.01, lambda: os.kill(os.getpid(), signal.SIGTERM))
        navette.spin(node)
        print("ended:", navette.ok())
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)],
        capture_output=True,
        text=True,
        check=True,
        timeout=30,
    )
    assert done.stdout == "ended: False\n"
