"""Parameters by service."""

from navette.runtime.parameter_service import ParameterService

__all__ = ["ParameterService"]
