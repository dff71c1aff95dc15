"""QoS overrides by parameters ``qos_overrides.<topic>.<kind>.<policy>``."""

import copy
from collections.abc import Callable, Iterable
from typing import Any, Self

from navette.errors import InvalidValueError
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from navette.runtime.qos import QoSPolicyEnum, QoSPolicyKind, QoSProfile
from navette.runtime.time import Duration

QosCallbackResult = SetParametersResult
QosCallbackType = Callable[[QoSProfile], SetParametersResult]


class InvalidQosOverridesError(InvalidValueError):
    """The overrides have an unknown value, or the callback rejects the profile."""


class QoSOverridingOptions:
    """Policies that parameters may override.

    Args:
        policy_kinds: each becomes a read-only parameter.
        callback: may reject the resulting profile.
        entity_id: suffix for one of several endpoints of a topic.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: QosCallbackType | None = None,
        entity_id: str | None = None,
    ) -> None:
        self.policy_kinds = tuple(policy_kinds)
        self.callback = callback
        self.entity_id = entity_id

    @classmethod
    def with_default_policies(
        cls,
        *,
        callback: QosCallbackType | None = None,
        entity_id: str | None = None,
    ) -> Self:
        """Return options with history, depth and reliability."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)


def overridden(
    node: Any,
    kind: str,
    topic: str,
    qos: QoSProfile,
    options: QoSOverridingOptions,
) -> QoSProfile:
    """Return a copy of the profile with the values of the node's parameters.

    Args:
        node: has and declares the parameters.
        kind: ``publisher`` or ``subscription``.
        topic: full name.

    Raises:
        InvalidQosOverridesError: the policy has no such value, or the callback rejects
            the profile.
    """
    qos = copy.copy(qos)
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    for policy in options.policy_kinds:
        if policy is QoSPolicyKind.LIFESPAN and kind == "subscription":
            continue
        field = policy.name.lower()
        name = f"qos_overrides.{topic}.{kind}{suffix}.{field}"
        default = getattr(qos, field)
        if not node.has_parameter(name):
            descriptor = ParameterDescriptor(
                description=f"{field} of the {kind} of {topic}", read_only=True
            )
            node.declare_parameter(name, _to_parameter(default), descriptor)
        value = node.get_parameter(name).value
        setattr(qos, field, _from_parameter(name, value, default))
    if options.callback is not None:
        result = options.callback(qos)
        if not result.successful:
            raise InvalidQosOverridesError(
                f"QoS overrides of the {kind} of {topic} are not valid: {result.reason}"
            )
    return qos


def _to_parameter(value: Any) -> Any:
    if isinstance(value, QoSPolicyEnum):
        return value.short_key
    return value.nanoseconds if isinstance(value, Duration) else value


def _from_parameter(name: str, value: Any, default: Any) -> Any:
    if isinstance(default, Duration):
        return Duration(nanoseconds=value)
    if not isinstance(default, QoSPolicyEnum):
        return value
    known = type(default).short_keys()
    if value not in known:
        raise InvalidQosOverridesError(f"{name}: {value!r}; known: {', '.join(known)}")
    return type(default)(type(default).get_from_short_key(value))
