"""Booleans and numbers that may be given as substitutions."""

import math
from typing import Any

from navette.ros2.packages.launch.errors import (
    InvalidConditionExpressionError,
    InvalidLaunchValueError,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch.utilities.type_utils import coerce_to_type

TRUE = ("true", "1")
FALSE = ("false", "0")


def parse_bool(text: str) -> bool:
    """Parse ``true``, ``1``, ``false`` or ``0``, in any case.

    Raises:
        InvalidConditionExpressionError: any other text.
    """
    word = text.strip().lower()
    if word not in TRUE + FALSE:
        raise InvalidConditionExpressionError(f"{text!r}: expected true, 1, false or 0")
    return word in TRUE


def perform_bool(context: LaunchContext, value: Any) -> bool:
    """Return a bool given as such or as text, also ``on``, ``off``, ``yes``, ``no``."""
    if isinstance(value, bool):
        return value
    text = Parts.of(value).perform(context).strip().lower()
    try:
        return bool(coerce_to_type(text, bool))
    except ValueError:
        return parse_bool(text)


def perform_seconds(context: LaunchContext, value: Any, what: str) -> float:
    """Return a finite duration, 0 s or more, given as a number or as text."""
    number = value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        text = Parts.of(value).perform(context)
        try:
            number = float(text)
        except ValueError:
            raise InvalidLaunchValueError(
                f"{what} {text!r}: expected a number of seconds"
            ) from None
    if not (math.isfinite(number) and number >= 0):
        raise InvalidLaunchValueError(f"{what} {number!r}: expected 0 seconds or more")
    return float(number)
