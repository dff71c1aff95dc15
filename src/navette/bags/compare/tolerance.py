"""Tolerances of numbers by topic and field."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from navette.errors import InvalidValueError

_FORMS = "expected VALUE or TOPIC[.FIELD]=VALUE, with VALUE as 0.01 or 0.01:2%"


@dataclass(frozen=True)
class Tolerance:
    """``absolute`` in the field's unit; ``share`` of an array's elements may exceed
    it. A text may always become ``stand_in``, if that is not empty."""

    absolute: float = 0.0
    share: float = 0.0
    stand_in: str = ""


EXACT = Tolerance()


@dataclass
class Tolerances:
    """Tolerance rules; the last rule that matches a field applies.

    A rule's pattern is a topic, or a topic and a field as in
    ``/path.poses[].pose.position.x``; it applies to all fields below. ``*`` matches any
    text. ``stand_in`` is the name of a node that stands for those of the recording: it
    may replace any text.
    """

    stand_in: str = ""
    rules: list[tuple[str, Tolerance]] = field(default_factory=list)
    _found: dict[str, Tolerance] = field(default_factory=dict, repr=False)

    @classmethod
    def parse(cls, texts: Iterable[str]) -> "Tolerances":
        """Parse rules such as ``0.01``, ``/path=0.01``, ``/costmap.data=0:0.5%``.

        Raises:
            InvalidValueError: invalid syntax.
        """
        tolerances = cls()
        for text in texts:
            pattern, equals, value = text.rpartition("=")
            if equals and not pattern:
                raise InvalidValueError(f"tolerance {text!r}: {_FORMS}")
            tolerances.add(pattern or "*", *_numbers(value, text))
        return tolerances

    def add(self, pattern: str, absolute: float, share: float = 0.0) -> None:
        """Add a rule that overrides earlier ones."""
        self.rules.append((pattern, Tolerance(absolute, share)))
        self._found.clear()

    def of(self, topic: str, path: str) -> Tolerance:
        """Return the tolerance of a field (``""``: of the whole topic)."""
        key = f"{topic}.{path}" if path else topic
        if key not in self._found:
            matching = [t for pattern, t in self.rules if _matches(pattern, key)]
            found = matching[-1] if matching else EXACT
            self._found[key] = replace(found, stand_in=self.stand_in)
        return self._found[key]


def _numbers(value: str, text: str) -> tuple[float, float]:
    absolute_text, colon, share_text = value.partition(":")
    try:
        absolute = float(absolute_text)
        share = float(share_text.removesuffix("%")) if colon else 0.0
    except ValueError:
        raise InvalidValueError(f"tolerance {text!r}: {_FORMS}") from None
    if share_text.endswith("%"):
        share /= 100.0
    if not (0.0 <= absolute < math.inf and 0.0 <= share <= 1.0):
        raise InvalidValueError(
            f"tolerance {text!r}: expected 0 or more, and a share of 0 to 100 %"
        )
    return absolute, share


def _matches(pattern: str, key: str) -> bool:
    expression = re.escape(pattern).replace(r"\*", ".*")
    return re.fullmatch(rf"{expression}([.\[].*)?", key) is not None
