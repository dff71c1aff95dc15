"""Log levels by service."""

from navette.runtime.logging_service import LoggingService

__all__ = ["LoggingService"]
