"""Changes of parameters, of any node."""

from navette.runtime.parameter_event_handler import (
    ParameterCallbackHandle,
    ParameterEventCallbackHandle,
    ParameterEventHandler,
)

__all__ = [
    "ParameterCallbackHandle",
    "ParameterEventCallbackHandle",
    "ParameterEventHandler",
]
