"""QoS as one chunk of a liveliness token; default values are left empty.

``<rel>:<dur>:<hist>,<depth>:<deadline s>,<ns>:<lifespan s>,<ns>:<liv>,<lease s>,<ns>``
The default of a duration is infinite: 9223372036 s and 854775807 ns, each half of
which is left empty on its own. rmw_zenoh writes both as numbers of up to 64 bits.
"""

import re
from dataclasses import replace

from navette.errors import DecodeError
from navette.transports.qos import (
    DEFAULT_DEPTH,
    INFINITE_NS,
    DurabilityPolicy,
    EndpointQos,
    HistoryPolicy,
    LivelinessPolicy,
    ReliabilityPolicy,
)

_DURATION = r"(\d{0,20}),(\d{0,20})"
_CHUNK = re.compile(
    rf"(\d?):(\d?):(\d?),(\d{{0,10}}):{_DURATION}:{_DURATION}:(\d?),{_DURATION}",
    re.ASCII,
)
_NS = 1_000_000_000
_INFINITE_HALVES = divmod(INFINITE_NS, _NS)

# Values that a profile leaves open, and what rmw_zenoh replaces them by.
_RELIABILITY = {
    ReliabilityPolicy.SYSTEM_DEFAULT: ReliabilityPolicy.RELIABLE,
    ReliabilityPolicy.UNKNOWN: ReliabilityPolicy.RELIABLE,
}
_DURABILITY = {
    DurabilityPolicy.SYSTEM_DEFAULT: DurabilityPolicy.VOLATILE,
    DurabilityPolicy.UNKNOWN: DurabilityPolicy.VOLATILE,
}


def announced(qos: EndpointQos, *, offers: bool) -> EndpointQos:
    """Return the QoS to announce, without open values.

    ``BEST_AVAILABLE`` becomes the strongest policy of an endpoint that ``offers`` (a
    publisher) and the weakest of one that requests.
    """
    reliability = _RELIABILITY.get(qos.reliability, qos.reliability)
    if reliability == ReliabilityPolicy.BEST_AVAILABLE:
        reliability = (
            ReliabilityPolicy.RELIABLE if offers else ReliabilityPolicy.BEST_EFFORT
        )
    durability = _DURABILITY.get(qos.durability, qos.durability)
    if durability == DurabilityPolicy.BEST_AVAILABLE:
        durability = (
            DurabilityPolicy.TRANSIENT_LOCAL if offers else DurabilityPolicy.VOLATILE
        )
    manual = qos.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
    keeps_all = qos.history == HistoryPolicy.KEEP_ALL
    return replace(
        qos,
        reliability=reliability,
        durability=durability,
        history=HistoryPolicy.KEEP_ALL if keeps_all else HistoryPolicy.KEEP_LAST,
        depth=qos.depth or DEFAULT_DEPTH,
        liveliness=(
            LivelinessPolicy.MANUAL_BY_TOPIC if manual else LivelinessPolicy.AUTOMATIC
        ),
    )


def format_qos(qos: EndpointQos) -> str:
    """Return the chunk for a QoS without open values (see :func:`announced`)."""
    return ":".join(
        (
            _or_empty(qos.reliability, ReliabilityPolicy.RELIABLE),
            _or_empty(qos.durability, DurabilityPolicy.VOLATILE),
            f"{_or_empty(qos.history, HistoryPolicy.KEEP_LAST)},"
            f"{_or_empty(qos.depth, DEFAULT_DEPTH)}",
            _format_duration(qos.deadline_ns),
            _format_duration(qos.lifespan_ns),
            f"{_or_empty(qos.liveliness, LivelinessPolicy.AUTOMATIC)},"
            f"{_format_duration(qos.lease_ns)}",
        )
    )


def parse_qos(chunk: str) -> EndpointQos:
    """Decode the chunk of a QoS.

    Raises:
        DecodeError: ``chunk`` is not a QoS.
    """
    match = _CHUNK.fullmatch(chunk)
    if match is None:
        raise DecodeError(f"{chunk[:100]!r} is not a QoS")
    parts = match.groups()
    try:
        return EndpointQos(
            reliability=ReliabilityPolicy(_number(parts[0], 1)),
            durability=DurabilityPolicy(_number(parts[1], 2)),
            history=HistoryPolicy(_number(parts[2], 1)),
            depth=_number(parts[3], DEFAULT_DEPTH),
            deadline_ns=_duration(parts[4], parts[5]),
            lifespan_ns=_duration(parts[6], parts[7]),
            liveliness=LivelinessPolicy(_number(parts[8], 1)),
            lease_ns=_duration(parts[9], parts[10]),
        )
    except ValueError as error:
        raise DecodeError(f"{chunk!r} is not a QoS: {error}") from None


def _or_empty(value: int, default: int) -> str:
    return "" if value == default else str(int(value))


def _number(text: str, default: int) -> int:
    return int(text) if text else default


def _format_duration(duration_ns: int) -> str:
    halves = divmod(min(duration_ns, INFINITE_NS), _NS)
    return ",".join(map(_or_empty, halves, _INFINITE_HALVES))


def _duration(seconds: str, nanoseconds: str) -> int:
    default_s, default_ns = _INFINITE_HALVES
    total = _number(seconds, default_s) * _NS + _number(nanoseconds, default_ns)
    return min(total, INFINITE_NS)
