"""Time and Duration: integer nanoseconds with ROS 2's arithmetic."""

from enum import IntEnum
from functools import total_ordering
from typing import Union, overload

from navette.msgs.builtin_interfaces.msg import Duration as DurationMsg
from navette.msgs.builtin_interfaces.msg import Time as TimeMsg
from navette.transports.qos import INFINITE_NS

NS_PER_S = 1_000_000_000
_MAX_NS = 2**63 - 1


class ClockType(IntEnum):
    """Kind of time of a clock; values as in rcl."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Convert seconds to nanoseconds; None or negative: -1, meaning no limit."""
    if timeout_sec is None or timeout_sec < 0:
        return -1
    return int(float(timeout_sec) * NS_PER_S)


def seconds_to_ns(seconds: float) -> int:
    """Round ``seconds`` to whole nanoseconds; exact for an ``int``."""
    if isinstance(seconds, int):
        return seconds * NS_PER_S
    whole = int(seconds)
    return whole * NS_PER_S + round((seconds - whole) * NS_PER_S)


@total_ordering
class Duration:
    """A span of time; positive or negative."""

    __slots__ = ("_ns",)

    def __init__(self, *, seconds: float = 0, nanoseconds: int = 0) -> None:
        total = seconds_to_ns(seconds) + int(nanoseconds)
        if not -_MAX_NS - 1 <= total <= _MAX_NS:
            raise OverflowError(
                f"duration of {total} ns does not fit into 64 bits of nanoseconds"
            )
        self._ns = total

    @property
    def nanoseconds(self) -> int:
        return self._ns

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._ns})"

    def __str__(self) -> str:
        return "Infinite" if self._ns == INFINITE_NS else f"{self._ns} nanoseconds"

    def __hash__(self) -> int:
        return hash(self._ns)

    def __add__(self, other: "Duration") -> "Duration":
        if isinstance(other, Duration):
            return Duration(nanoseconds=self._ns + other._ns)
        return NotImplemented

    def __sub__(self, other: "Duration") -> "Duration":
        if isinstance(other, Duration):
            return Duration(nanoseconds=self._ns - other._ns)
        return NotImplemented

    def __mul__(self, other: float) -> "Duration":
        if isinstance(other, int):
            return Duration(nanoseconds=self._ns * other)
        if isinstance(other, float):
            return Duration(nanoseconds=round(self._ns * other))
        return NotImplemented

    def __neg__(self) -> "Duration":
        return Duration(nanoseconds=-self._ns)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self._ns == other._ns
        return NotImplemented

    def __lt__(self, other: object) -> bool:
        return self._ns < other._ns if isinstance(other, Duration) else NotImplemented

    def to_msg(self) -> DurationMsg:
        seconds, nanoseconds = divmod(self._ns, NS_PER_S)
        return DurationMsg(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: DurationMsg) -> "Duration":
        if not isinstance(msg, DurationMsg):
            raise TypeError(f"expected a builtin_interfaces/msg/Duration, got {msg!r}")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)


Infinite = Duration(nanoseconds=INFINITE_NS)


@total_ordering
class Time:
    """A point in time of a clock; only times of one clock type can be compared."""

    __slots__ = ("_clock_type", "_ns")

    def __init__(
        self,
        *,
        seconds: float = 0,
        nanoseconds: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError(f"clock_type must be a ClockType, got {clock_type!r}")
        if seconds < 0:
            raise ValueError(f"seconds must not be negative, got {seconds}")
        if nanoseconds < 0:
            raise ValueError(f"nanoseconds must not be negative, got {nanoseconds}")
        total = seconds_to_ns(seconds) + int(nanoseconds)
        if total > _MAX_NS:
            raise OverflowError(f"{total} ns does not fit into 64 bits of nanoseconds")
        self._ns = total
        self._clock_type = clock_type

    @property
    def nanoseconds(self) -> int:
        return self._ns

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Time as separate seconds and nanoseconds components."""
        return divmod(self._ns, NS_PER_S)

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._ns}, clock_type={self._clock_type.name})"

    def __hash__(self) -> int:
        return hash((self._ns, self._clock_type))

    def __add__(self, other: Duration) -> "Time":
        if isinstance(other, Duration):
            return self._moved(other.nanoseconds)
        return NotImplemented

    __radd__ = __add__

    @overload
    def __sub__(self, other: "Time") -> Duration: ...
    @overload
    def __sub__(self, other: Duration) -> "Time": ...
    def __sub__(self, other: Union["Time", Duration]) -> Union["Time", Duration]:
        if isinstance(other, Time):
            self._check_comparable(other)
            return Duration(nanoseconds=self._ns - other._ns)
        if isinstance(other, Duration):
            if other.nanoseconds > self._ns:
                raise ValueError(f"{self} - {other} is a negative time")
            return self._moved(-other.nanoseconds)
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Time):
            self._check_comparable(other)
            return self._ns == other._ns
        return NotImplemented

    def __lt__(self, other: object) -> bool:
        if isinstance(other, Time):
            self._check_comparable(other)
            return self._ns < other._ns
        return NotImplemented

    def to_msg(self) -> TimeMsg:
        seconds, nanoseconds = divmod(self._ns, NS_PER_S)
        return TimeMsg(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(
        cls, msg: TimeMsg, clock_type: ClockType = ClockType.ROS_TIME
    ) -> "Time":
        if not isinstance(msg, TimeMsg):
            raise TypeError(f"expected a builtin_interfaces/msg/Time, got {msg!r}")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)

    def _moved(self, by_ns: int) -> "Time":
        total = self._ns + by_ns
        if not 0 <= total <= _MAX_NS:
            raise OverflowError(f"{total} ns is outside 0 … 2^63 − 1 ns")
        return Time(nanoseconds=total, clock_type=self._clock_type)

    def _check_comparable(self, other: "Time") -> None:
        if self._clock_type != other._clock_type:
            raise TypeError(
                "cannot compare times of different clock types: "
                f"{self._clock_type.name} and {other._clock_type.name}"
            )


def stamp_to_ns(stamp: TimeMsg) -> int:
    """Convert a message's stamp to nanoseconds; cheaper than :class:`Time`."""
    return stamp.sec * NS_PER_S + stamp.nanosec


def ns_to_stamp(stamp_ns: int) -> TimeMsg:
    """Convert nanoseconds to a message's stamp."""
    seconds, nanoseconds = divmod(stamp_ns, NS_PER_S)
    return TimeMsg(sec=seconds, nanosec=nanoseconds)
