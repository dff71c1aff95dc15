"""Names near a mistyped one, for messages that help."""

from collections.abc import Iterable
from difflib import get_close_matches

_MOST = 3


def nearest(name: str, known: Iterable[str]) -> list[str]:
    """Those that were probably meant, the likeliest first.

    Near are names with the same last part (``planner`` for ``/robot1/planner``), and
    names that differ in a few letters.
    """
    every = sorted(set(known))
    last = name.rpartition("/")[2]
    same = [each for each in every if last and each.rpartition("/")[2] == last]
    close = get_close_matches(name, every, n=_MOST, cutoff=0.6)
    inside = [each for each in every if len(last) > 2 and last in each]
    return list(dict.fromkeys([*same, *close, *inside]))[:_MOST]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """``; did you mean /planner?``, or nothing."""
    near = nearest(name, known)
    return f"; did you mean {' or '.join(near)}?" if near else ""
