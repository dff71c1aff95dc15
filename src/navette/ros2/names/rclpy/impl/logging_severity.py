"""Severities of log messages."""

from navette.runtime.log_levels import LoggingSeverity

__all__ = ["LoggingSeverity"]
