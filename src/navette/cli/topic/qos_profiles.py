"""QoS profiles from command-line overrides and from the publishers' QoS."""

import copy
import math
from typing import TypeVar

from navette.cli.topic.options import QosOverrides
from navette.errors import InvalidValueError
from navette.runtime import QoSPresetProfiles, QoSProfile
from navette.runtime.qos import QoSPolicyEnum
from navette.runtime.time import Duration
from navette.transports import (
    DurabilityPolicy,
    Endpoint,
    HistoryPolicy,
    LivelinessPolicy,
    ReliabilityPolicy,
)

P = TypeVar("P", bound=QoSPolicyEnum)

MAX_DEPTH = 1000


def overridden_profile(overrides: QosOverrides, preset: str) -> QoSProfile:
    """Return the preset profile with the overrides applied.

    Raises:
        InvalidValueError: unknown policy value; the message lists the known ones.
    """
    name = overrides.profile or preset
    if name not in QoSPresetProfiles.short_keys():
        known = ", ".join(QoSPresetProfiles.short_keys())
        raise InvalidValueError(f"--qos-profile {name!r}; known: {known}")
    profile = copy.copy(QoSPresetProfiles.get_from_short_key(name))
    if overrides.history is not None:
        profile.history = _policy(HistoryPolicy, "history", overrides.history)
    if overrides.reliability is not None:
        profile.reliability = _policy(
            ReliabilityPolicy, "reliability", overrides.reliability
        )
    if overrides.durability is not None:
        profile.durability = _policy(
            DurabilityPolicy, "durability", overrides.durability
        )
    if overrides.liveliness is not None:
        profile.liveliness = _policy(
            LivelinessPolicy, "liveliness", overrides.liveliness
        )
    if overrides.lease_s is not None:
        profile.liveliness_lease_duration = _lease(overrides.lease_s)
    if overrides.depth is not None:
        profile.depth = overrides.depth
    return profile


def compatible_profile(publishers: list[Endpoint], depth: int = 10) -> QoSProfile:
    """Return the strictest profile that is compatible with all publishers.

    Requests transient_local only if every publisher offers it: a volatile publisher
    would be incompatible.
    """
    qos = [each.qos for each in publishers]
    reliable = bool(qos) and all(
        each.reliability != ReliabilityPolicy.BEST_EFFORT for each in qos
    )
    latched = bool(qos) and all(
        each.durability == DurabilityPolicy.TRANSIENT_LOCAL for each in qos
    )
    kept = sum(each.queue_length or MAX_DEPTH for each in qos) if latched else 0
    return QoSProfile(
        depth=min(max(depth, kept), MAX_DEPTH),
        reliability=ReliabilityPolicy.RELIABLE
        if reliable
        else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL
        if latched
        else DurabilityPolicy.VOLATILE,
    )


def _policy(kind: type[P], word: str, name: str) -> P:
    if name not in kind.short_keys():
        known = ", ".join(kind.short_keys())
        raise InvalidValueError(f"--qos-{word} {name!r}; known: {known}")
    return kind(kind.get_from_short_key(name))


def _lease(seconds: float) -> Duration:
    if not (math.isfinite(seconds) and seconds > 0):
        raise InvalidValueError(
            f"--qos-liveliness-lease-duration-seconds {seconds!r} is not a finite"
            " number above 0"
        )
    return Duration(seconds=seconds)
