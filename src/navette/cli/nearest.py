"""Names near a mistyped one, for messages that help."""

from collections.abc import Iterable
from difflib import SequenceMatcher

_MOST = 3
_ALIKE = 0.6  # of letters in common, from 0 to 1
_AS_GOOD = 0.1  # how much less is still as good as the best


def nearest(name: str, known: Iterable[str]) -> list[str]:
    """Those that were probably meant, the likeliest first.

    Near are names with the same last part (``planner`` for ``/robot1/planner``), and
    names that differ in a few letters.
    """
    every = sorted(set(known))
    last = name.rpartition("/")[2]
    same = [each for each in every if last and each.rpartition("/")[2] == last]
    alike = {each: SequenceMatcher(None, name, each).ratio() for each in every}
    least = max(_ALIKE, max(alike.values(), default=0.0) - _AS_GOOD)
    close = sorted((e for e in every if alike[e] >= least), key=lambda e: -alike[e])
    inside = [each for each in every if len(last) > 2 and last in each]
    return (same or close or inside)[:_MOST]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """``; did you mean /planner?``, or nothing."""
    near = nearest(name, known)
    return f"; did you mean {' or '.join(near)}?" if near else ""
