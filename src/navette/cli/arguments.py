"""Preprocess command-line arguments, and parse goals and speeds."""

import math
from collections.abc import Collection, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.geometry import Pose2

PAIR_OPTIONS = ("--goal",)
_DAEMON_VERBS = (
    "topic",
    "node",
    "param",
    "service",
    "action",
    "lifecycle",
    "component",
)
_VERBS_OF_ONE_NODE = {
    *(("param", each) for each in ("get", "set", "describe", "load", "delete")),
    *(("lifecycle", each) for each in ("set", "list")),
}
OPTIONAL_VALUES = {"--clock": "40"}


def join_pairs(arguments: Sequence[str]) -> list[str]:
    """Join ``--goal X Y`` (or ``--goal=X Y``) to one value, ``--goal "X Y"``.

    Click could take two numbers, but not also ``--goal "X Y"`` and ``--goal X,Y``.
    """
    joined: list[str] = []
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        option, equals, value = word.partition("=")
        if equals and option in PAIR_OPTIONS:
            word, rest = option, [value, *rest]
        joined.append(word)
        if word in PAIR_OPTIONS and len(rest) >= 2 and all(map(_is_number, rest[:2])):
            joined.append(f"{rest.pop(0)} {rest.pop(0)}")
    return joined


def fill_values(arguments: Sequence[str]) -> list[str]:
    """Replace ``--clock`` without a number by ``--clock 40``, as in ROS 2's command."""
    filled: list[str] = []
    for word, following in pairwise([*arguments, ""]):
        filled.append(word)
        if word in OPTIONAL_VALUES and not _is_number(following):
            filled.append(OPTIONAL_VALUES[word])
    return filled


def split_run(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Separate ``--run NAME``, which holds for all verbs, from the other arguments.

    The arguments of the program that ``navette run`` runs remain as they are.

    Raises:
        InvalidValueError: the name is missing.
    """
    chosen: list[str] = []
    kept: list[str] = []
    rest = list(arguments)
    is_run_verb = rest[:1] == ["run"] or rest[2:3] == ["run"]  # --domain-id N run
    while rest:
        word = rest.pop(0)
        if word == "--run":
            if not rest:
                raise InvalidValueError("--run: no name; navette ps lists the runs")
            chosen += [word, rest.pop(0)]
        elif word.startswith("--run="):
            chosen.append(word)
        else:
            kept.append(word)
            if is_run_verb and word == "--path" and rest:
                kept.append(rest.pop(0))
            elif word == "--" or (is_run_verb and word[:1] != "-" and len(kept) > 1):
                return chosen, [*kept, *rest]
    return chosen, kept


def without_daemon(arguments: Sequence[str]) -> list[str]:
    """Remove discovery options of ROS 2's command, such as ``--no-daemon``.

    Scripts written for ROS 2 contain them. They have no effect here: there is no
    daemon, discovery is immediate, and a node given by name is found even if hidden.
    """
    # Only --domain-id N can precede the verb.
    words = [w for w in arguments if w[:1] != "-" and not w.isdigit()]
    if not words or words[0] not in _DAEMON_VERBS:
        return list(arguments)
    nothing = {"--no-daemon"}
    if tuple(words[:2]) in _VERBS_OF_ONE_NODE:
        nothing.add("--include-hidden-nodes")
    kept: list[str] = []
    skipping = False
    for word in arguments:
        if not (skipping or word in nothing or word.startswith("--spin-time=")):
            kept += [] if word == "--spin-time" else [word]
        skipping = word == "--spin-time" and not skipping
    return kept


def spread_lists(arguments: Sequence[str], options: Collection[str]) -> list[str]:
    """Expand ``--topics a b`` to ``--topics a --topics b`` for these options."""
    spread: list[str] = []
    option = ""
    for word in arguments:
        if word.startswith("-"):
            option = word if word in options else ""
        elif option and spread[-1] != option:
            spread.append(option)
        spread.append(word)
    return spread


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def parse_goal(text: str) -> tuple[float, float]:
    """Parse ``"X Y"`` or ``"X,Y"``, in metres."""
    words = text.replace(",", " ").split()
    numbers = [float(word) for word in words if _is_number(word)]
    if len(words) != 2 or len(numbers) != 2 or not all(map(math.isfinite, numbers)):
        raise InvalidValueError(
            f"--goal {text!r} is not two finite numbers in metres, as in --goal 6 -12"
        )
    return numbers[0], numbers[1]


def parse_speed(text: str) -> float:
    """Parse a real-time factor; ``max`` (as fast as possible) gives infinity."""
    if text == "max":
        return math.inf
    try:
        factor = float(text)
    except ValueError:
        factor = math.nan
    if not (math.isfinite(factor) and factor > 0):
        raise InvalidValueError(
            f"--speed {text!r} is not a factor above 0, as in 2.5, or max"
        )
    return factor


def start_pose(start: tuple[float, float, float] | None) -> "Pose2 | None":
    """Return the pose of ``--start X Y YAW_DEG``; None without the option."""
    from navette.geometry import Pose2  # not imported for completion and help

    return Pose2(start[0], start[1], math.radians(start[2])) if start else None
