"""Values that may be given as text: numbers and truths worked out late."""

import math
from typing import Any

from navette.ros2.packages.launch.errors import (
    InvalidConditionExpressionError,
    InvalidLaunchValueError,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

TRUE = ("true", "1")
FALSE = ("false", "0")


def truth(text: str) -> bool:
    """``true``, ``1``, ``false`` or ``0`` in any case.

    Raises:
        InvalidConditionExpressionError: anything else.
    """
    word = text.strip().lower()
    if word not in TRUE + FALSE:
        raise InvalidConditionExpressionError(
            f"{text!r} is neither true nor false; wanted true, 1, false or 0"
        )
    return word in TRUE


def perform_bool(context: LaunchContext, value: Any) -> bool:
    """A bool, or text that says one."""
    if isinstance(value, bool):
        return value
    return truth(_text(context, value))


def perform_seconds(context: LaunchContext, value: Any, what: str) -> float:
    """A finite number of seconds, 0 or more, or text that says one."""
    number = value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        text = _text(context, value)
        try:
            number = float(text)
        except ValueError:
            raise InvalidLaunchValueError(
                f"{what} {text!r}: wanted a number of seconds"
            ) from None
    if not (math.isfinite(number) and number >= 0):
        raise InvalidLaunchValueError(f"{what} {number!r}: wanted 0 seconds or more")
    return float(number)


def _text(context: LaunchContext, value: Any) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))
