"""Rate, bandwidth and delay over a window of the newest messages.

The output format is that of ``ros2 topic hz``, ``bw`` and ``delay``. Times are in
nanoseconds.
"""

import math
from abc import ABC, abstractmethod
from collections import deque
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

_UNITS = ((1e6, "MB"), (1e3, "KB"), (1.0, "B"))


@dataclass(frozen=True)
class Spread:
    """Mean, minimum, maximum and population standard deviation."""

    mean: float
    min: float
    max: float
    std_dev: float
    window: int

    @classmethod
    def of(cls, values: "deque[int]", scale: float = 1.0) -> "Spread":
        """Compute the statistics of at least one value, each times ``scale``."""
        mean = sum(values) / len(values)
        variance = sum((value - mean) ** 2 for value in values) / len(values)
        return cls(
            mean * scale,
            min(values) * scale,
            max(values) * scale,
            math.sqrt(variance) * scale,
            len(values),
        )

    @property
    def text(self) -> str:
        return (
            f"\tmin: {self.min:.3f}s max: {self.max:.3f}s "
            f"std dev: {self.std_dev:.5f}s window: {self.window}"
        )


class Meter(ABC):
    """Statistics of messages; cleared when time jumps back."""

    def __init__(self) -> None:
        self._last_ns: int | None = None
        self._is_new = False

    def add(self, now_ns: int, value: int) -> bool:
        """Add a message; return False if time jumped back and the meter was cleared."""
        went_back = self._last_ns is not None and now_ns < self._last_ns
        if went_back:
            self._forget()
        self._take(now_ns, value, self._last_ns if not went_back else None)
        self._last_ns = now_ns
        self._is_new = True
        return not went_back

    def figures(self, now_ns: int) -> Any:
        """Return a dataclass of figures; None without new or with too few messages."""
        if not self._is_new:
            return None
        self._is_new = False
        return self._figures(now_ns)

    @abstractmethod
    def text(self, figures: Any) -> str:
        """Format the figures in two lines."""

    def to_json(self, figures: Any) -> dict[str, Any]:
        return asdict(figures)

    columns: ClassVar[tuple[str, ...]] = ()
    """Titles of :meth:`row`."""

    def row(self, figures: Any) -> tuple[str, ...]:
        """Format the figures as a row of a table of topics."""
        return ()

    @abstractmethod
    def _take(self, now_ns: int, value: int, last_ns: int | None) -> None:
        """Store the value of a message; ``last_ns`` is the previous arrival."""

    @abstractmethod
    def _forget(self) -> None:
        """Clear the stored values."""

    @abstractmethod
    def _figures(self, now_ns: int) -> Any:
        """Compute the figures; None if there are too few values."""


class RateMeter(Meter):
    """Rate, from the intervals between messages."""

    def __init__(self, window: int) -> None:
        super().__init__()
        self._intervals: deque[int] = deque(maxlen=window)

    def _take(self, now_ns: int, value: int, last_ns: int | None) -> None:
        if last_ns is not None:
            self._intervals.append(now_ns - last_ns)

    def _forget(self) -> None:
        self._intervals.clear()

    def _figures(self, now_ns: int) -> Spread | None:
        return Spread.of(self._intervals, 1e-9) if self._intervals else None

    @staticmethod
    def rate_hz(spread: Spread) -> float:
        return 1.0 / spread.mean if spread.mean > 0 else 0.0

    def text(self, figures: Spread) -> str:
        return f"average rate: {self.rate_hz(figures):.3f}\n{figures.text}"

    columns = ("rate", "min_delta", "max_delta", "std_dev", "window")

    def row(self, figures: Spread) -> tuple[str, ...]:
        return (
            f"{self.rate_hz(figures):.3f}",
            f"{figures.min:.3f}",
            f"{figures.max:.3f}",
            f"{figures.std_dev:.5f}",
            str(figures.window),
        )

    def to_json(self, figures: Spread) -> dict[str, Any]:
        return {"rate_hz": self.rate_hz(figures), **asdict(figures)}


class DelayMeter(Meter):
    """Delay, from the stamp of each message to its arrival."""

    def __init__(self, window: int) -> None:
        super().__init__()
        self._delays: deque[int] = deque(maxlen=window)

    def _take(self, now_ns: int, value: int, last_ns: int | None) -> None:
        self._delays.append(now_ns - value)

    def _forget(self) -> None:
        self._delays.clear()

    def _figures(self, now_ns: int) -> Spread:
        return Spread.of(self._delays, 1e-9)

    def text(self, figures: Spread) -> str:
        return f"average delay: {figures.mean:.3f}\n{figures.text}"


@dataclass(frozen=True)
class Load:
    """Bandwidth in bytes per second, and message sizes in bytes."""

    bytes_per_s: float
    mean: float
    min: int
    max: int
    window: int


class LoadMeter(Meter):
    """Bandwidth, from the serialized sizes of messages."""

    def __init__(self, window: int) -> None:
        super().__init__()
        self._sizes: deque[int] = deque(maxlen=window)
        self._times_ns: deque[int] = deque(maxlen=window)

    def _take(self, now_ns: int, value: int, last_ns: int | None) -> None:
        self._times_ns.append(now_ns)
        self._sizes.append(value)

    def _forget(self) -> None:
        self._sizes.clear()
        self._times_ns.clear()

    def _figures(self, now_ns: int) -> Load | None:
        if len(self._sizes) < 2 or now_ns <= self._times_ns[0]:
            return None
        total = sum(self._sizes)
        return Load(
            total / ((now_ns - self._times_ns[0]) * 1e-9),
            total / len(self._sizes),
            min(self._sizes),
            max(self._sizes),
            len(self._sizes),
        )

    def text(self, figures: Load) -> str:
        per_s, *sizes = _sizes_text(figures)
        mean, least, most = sizes
        return (
            f"{per_s}/s from {figures.window} messages\n"
            f"\tMessage size mean: {mean} min: {least} max: {most}"
        )

    columns = ("bandwidth", "window", "mean", "min", "max")

    def row(self, figures: Load) -> tuple[str, ...]:
        per_s, *sizes = _sizes_text(figures)
        return (f"{per_s}/s", str(figures.window), *sizes)


def _sizes_text(figures: Load) -> list[str]:
    """Format bytes per second, mean, minimum and maximum in one unit."""
    scale, unit = next(
        (each for each in _UNITS if figures.bytes_per_s >= each[0]), _UNITS[-1]
    )
    sizes = (figures.bytes_per_s, figures.mean, figures.min, figures.max)
    return [f"{s:.0f} B" if unit == "B" else f"{s / scale:.2f} {unit}" for s in sizes]
