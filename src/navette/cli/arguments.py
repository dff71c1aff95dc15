"""Reading what a person typed: goals, speeds, and errors that say what to do."""

import math
from collections.abc import Sequence

from navette.errors import InvalidValueError

PAIR_OPTIONS = ("--goal",)


def join_pairs(arguments: Sequence[str]) -> list[str]:
    """Make ``--goal X Y`` one value, ``--goal "X Y"``, for each repetition.

    Why: Typer takes options that repeat, and options with two values, but not an
    option that does both.
    """
    joined: list[str] = []
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        joined.append(word)
        if word in PAIR_OPTIONS and len(rest) >= 2 and _is_number(rest[1]):
            joined.append(f"{rest.pop(0)} {rest.pop(0)}")
    return joined


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def parse_goal(text: str) -> tuple[float, float]:
    """``"X Y"`` (or ``"X,Y"``) in metres; NaN passes, the planner names it."""
    words = text.replace(",", " ").split()
    if len(words) != 2 or not all(_is_number(word) for word in words):
        raise InvalidValueError(
            f"--goal {text!r}: wanted two numbers in metres, as in --goal 6 -12"
        )
    return float(words[0]), float(words[1])


def parse_speed(text: str) -> float:
    """A factor of real time, or ``max`` (infinity): as fast as the machine can."""
    if text == "max":
        return math.inf
    try:
        factor = float(text)
    except ValueError:
        factor = math.nan
    if not (math.isfinite(factor) and factor > 0):
        raise InvalidValueError(
            f"--speed {text!r}: wanted a factor above 0, as in 2.5, or max"
        )
    return factor
