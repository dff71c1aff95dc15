"""Signals."""

from navette.runtime import SignalHandlerOptions

__all__ = ["SignalHandlerOptions"]
