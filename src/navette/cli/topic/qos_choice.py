"""From wishes and what is offered to a profile."""

import copy
import math
from typing import TypeVar

from navette.cli.topic.qos_options import QosWishes
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


def wished_profile(wishes: QosWishes, preset: str) -> QoSProfile:
    """The preset with what was wished otherwise.

    Raises:
        InvalidValueError: an unknown word; lists those known.
    """
    name = wishes.profile or preset
    if name not in QoSPresetProfiles.short_keys():
        known = ", ".join(QoSPresetProfiles.short_keys())
        raise InvalidValueError(f"--qos-profile {name!r}; known: {known}")
    profile = copy.copy(QoSPresetProfiles.get_from_short_key(name))
    if wishes.history is not None:
        profile.history = _policy(HistoryPolicy, "history", wishes.history)
    if wishes.reliability is not None:
        profile.reliability = _policy(
            ReliabilityPolicy, "reliability", wishes.reliability
        )
    if wishes.durability is not None:
        profile.durability = _policy(DurabilityPolicy, "durability", wishes.durability)
    if wishes.liveliness is not None:
        profile.liveliness = _policy(LivelinessPolicy, "liveliness", wishes.liveliness)
    if wishes.lease_s is not None:
        profile.liveliness_lease_duration = _lease(wishes.lease_s)
    if wishes.depth is not None:
        profile.depth = wishes.depth
    return profile


def fitting_profile(publishers: list[Endpoint], depth: int = 10) -> QoSProfile:
    """What all the publishers can serve, and as much of it as they offer.

    Latched samples are asked for where every publisher keeps some: asked of one that
    keeps none, it would be heard no more.
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
            f"--qos-liveliness-lease-duration-seconds {seconds!r}: wanted above 0"
        )
    return Duration(seconds=seconds)
