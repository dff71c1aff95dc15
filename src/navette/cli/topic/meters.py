"""How often, how much, how late: figures over a window of the newest messages.

Texts are those of ``ros2 topic hz``, ``bw`` and ``delay``. Times are nanoseconds of
the clock that is measured with.
"""

import math
from abc import ABC, abstractmethod
from collections import deque
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

_UNITS = ((1e6, "MB"), (1e3, "KB"), (1.0, "B"))


@dataclass(frozen=True)
class Spread:
    """Mean, extremes and (population) standard deviation of some values."""

    mean: float
    min: float
    max: float
    std_dev: float
    window: int

    @classmethod
    def of(cls, values: "deque[int]", scale: float = 1.0) -> "Spread":
        """Of at least one value, each times ``scale``."""
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
    """Takes in messages, gives figures; forgets all when time goes back."""

    def __init__(self) -> None:
        self._last_ns: int | None = None
        self._is_new = False

    def add(self, now_ns: int, value: int) -> bool:
        """Take in a message; False if time had gone back and all was forgotten."""
        went_back = self._last_ns is not None and now_ns < self._last_ns
        if went_back:
            self._forget()
        self._take(now_ns, value, self._last_ns if not went_back else None)
        self._last_ns = now_ns
        self._is_new = True
        return not went_back

    def figures(self, now_ns: int) -> Any:
        """A dataclass of figures; None without new messages, or too few of them."""
        if not self._is_new:
            return None
        self._is_new = False
        return self._figures(now_ns)

    @abstractmethod
    def text(self, figures: Any) -> str:
        """The figures in two lines."""

    def to_json(self, figures: Any) -> dict[str, Any]:
        return asdict(figures)

    columns: ClassVar[tuple[str, ...]] = ()
    """What :meth:`row` has."""

    def row(self, figures: Any) -> tuple[str, ...]:
        """The figures beside those of other topics."""
        return ()

    @abstractmethod
    def _take(self, now_ns: int, value: int, last_ns: int | None) -> None:
        """Keep what is needed of a message; ``last_ns``: when the last one came."""

    @abstractmethod
    def _forget(self) -> None:
        """Begin again."""

    @abstractmethod
    def _figures(self, now_ns: int) -> Any:
        """What is kept, summed up; None if it is too little."""


class RateMeter(Meter):
    """How often: from the times between messages."""

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
    """How late: from the times between a message's stamp and its arrival."""

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
    """Bytes per second, and the sizes of messages in bytes."""

    bytes_per_s: float
    mean: float
    min: int
    max: int
    window: int


class LoadMeter(Meter):
    """How much: from the sizes of messages on the wire."""

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
    """Bytes per second, mean, least, most: in the unit of the first."""
    scale, unit = next(
        (each for each in _UNITS if figures.bytes_per_s >= each[0]), _UNITS[-1]
    )
    sizes = (figures.bytes_per_s, figures.mean, figures.min, figures.max)
    return [f"{s:.0f} B" if unit == "B" else f"{s / scale:.2f} {unit}" for s in sizes]
