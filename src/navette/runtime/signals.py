"""Signal handling of a program's contexts.

SIGINT raises KeyboardInterrupt, as in plain Python, for all options: contexts stay
valid, so that a program can publish a last command. Shells start background jobs of
scripts with SIGINT ignored; as in rclpy, the option SIGINT ends that. SIGTERM shuts
down the contexts: spins end and ``ok()`` is false. Handlers of the program stay in
place.
"""

import signal
import threading
from enum import IntEnum
from types import FrameType

from navette.runtime.context import current_scope
from navette.runtime.guard_condition import GuardCondition


class SignalHandlerOptions(IntEnum):
    """Signals to handle; values as in rclpy."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


class _Installed:
    """Installed handlers of this process."""

    options = SignalHandlerOptions.NO
    is_ours = False


def install_signal_handlers(
    options: SignalHandlerOptions = SignalHandlerOptions.ALL,
) -> None:
    """Let SIGTERM shut down the contexts, and end an inherited "ignore SIGINT".

    Each if the options include the signal. Without effect if the program has its own
    handler, and outside the main thread, where Python does not allow handlers.
    """
    _Installed.options = SignalHandlerOptions(options)
    if threading.current_thread() is not threading.main_thread():
        return
    if options & SignalHandlerOptions.SIGINT:
        obey_interrupts()
    if not options & SignalHandlerOptions.SIGTERM:
        return
    if signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, _on_sigterm)
        _Installed.is_ours = True


def obey_interrupts() -> None:
    """Let SIGINT raise KeyboardInterrupt if this process inherited it as ignored."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def uninstall_signal_handlers() -> None:
    """Undo :func:`install_signal_handlers`."""
    _Installed.options = SignalHandlerOptions.NO
    if not _Installed.is_ours:
        return
    if threading.current_thread() is threading.main_thread():
        if signal.getsignal(signal.SIGTERM) is _on_sigterm:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
        _Installed.is_ours = False


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    return _Installed.options


def _on_sigterm(number: int, frame: FrameType | None) -> None:
    # A second SIGTERM ends a process that does not end by itself.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _Installed.is_ours = False
    contexts = [each for each in current_scope.get().contexts if each.ok()]
    if not contexts:  # another thread shut them down, but could not uninstall
        signal.raise_signal(number)
    for context in contexts:
        context.try_shutdown()


#: rclpy's guard condition for signals; in Navette, signals wake every wait.
SignalHandlerGuardCondition = GuardCondition
