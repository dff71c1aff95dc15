"""Signals."""

from navette.runtime import SignalHandlerOptions
from navette.runtime.signals import (
    SignalHandlerGuardCondition,
    get_current_signal_handlers_options,
    install_signal_handlers,
    uninstall_signal_handlers,
)

__all__ = [
    "SignalHandlerGuardCondition",
    "SignalHandlerOptions",
    "get_current_signal_handlers_options",
    "install_signal_handlers",
    "uninstall_signal_handlers",
]
