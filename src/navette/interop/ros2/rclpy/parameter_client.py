"""Parameters of other nodes."""

from navette.runtime.parameter_client import AsyncParameterClient

__all__ = ["AsyncParameterClient"]
