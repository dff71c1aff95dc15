"""Quality of service from parameters."""

from navette.runtime.qos_overriding_options import (
    InvalidQosOverridesError,
    QosCallbackResult,
    QosCallbackType,
    QoSOverridingOptions,
)

__all__ = [
    "InvalidQosOverridesError",
    "QoSOverridingOptions",
    "QosCallbackResult",
    "QosCallbackType",
]
