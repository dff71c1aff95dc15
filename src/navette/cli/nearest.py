"""Suggestions for mistyped names."""

from collections.abc import Iterable
from difflib import SequenceMatcher

_MOST = 3
_MIN_RATIO = 0.6  # of SequenceMatcher, 0 to 1
_RATIO_MARGIN = 0.1  # below the best ratio


def nearest(name: str, known: Iterable[str]) -> list[str]:
    """Return known names similar to a name, the most similar first.

    Names with the same last part (``planner`` for ``/robot1/planner``) come before
    names that differ in a few characters.
    """
    every = sorted(set(known))
    last = name.rpartition("/")[2]
    same = [each for each in every if last and each.rpartition("/")[2] == last]
    alike = {each: SequenceMatcher(None, name, each).ratio() for each in every}
    least = max(_MIN_RATIO, max(alike.values(), default=0.0) - _RATIO_MARGIN)
    close = sorted((e for e in every if alike[e] >= least), key=lambda e: -alike[e])
    inside = [each for each in every if len(last) > 2 and last in each]
    return (same or close or inside)[:_MOST]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return ``; did you mean /planner?``, or an empty string."""
    near = nearest(name, known)
    return f"; did you mean {' or '.join(near)}?" if near else ""
