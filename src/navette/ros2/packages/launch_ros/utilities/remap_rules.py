"""Remapping rules of nodes."""

from collections.abc import Iterable, Iterator
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts, Substitution

RemapRule = tuple[tuple[Substitution, ...], tuple[Substitution, ...]]


def normalize_remap_rule(remap_rule: Any) -> RemapRule:
    """Return the two names of a rule as substitutions.

    Raises:
        TypeError: not a tuple of two.
    """
    if not isinstance(remap_rule, tuple) or len(remap_rule) != 2:
        raise InvalidLaunchValueError(
            f"remappings: {remap_rule!r}: expected a pair, as in ('from', 'to')"
        )
    source, target = remap_rule
    return tuple(Parts.of(source)), tuple(Parts.of(target))


def normalize_remap_rules(remap_rules: Iterable[Any]) -> Iterator[RemapRule]:
    """Yield the normalized form of several rules."""
    return map(normalize_remap_rule, remap_rules)


def evaluate_remap_rules(
    context: LaunchContext, rules: Iterable[RemapRule]
) -> list[tuple[str, str]]:
    """Return the two names of each rule."""
    return [
        (
            "".join(context.perform_substitution(part) for part in source),
            "".join(context.perform_substitution(part) for part in target),
        )
        for source, target in rules
    ]
