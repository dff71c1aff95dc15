"""Boolean substitutions and the conditional."""

import math
from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch.errors import (
    InvalidConditionExpressionError,
    InvalidLaunchValueError,
    SubstitutionFailure,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    Substitution,
    perform_substitutions,
)
from navette.ros2.packages.launch.typed import parse_bool, perform_bool


def _word(value: bool) -> str:
    return "true" if value else "false"


def _is_true(context: LaunchContext, parts: Parts, what: str) -> bool:
    try:
        return parse_bool(parts.perform(context))
    except InvalidConditionExpressionError as error:
        raise SubstitutionFailure(f"{what}: {error}") from None


class NotSubstitution(Substitution):
    """Negation (``$(not x)``)."""

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = Parts.of(value)

    def perform(self, context: LaunchContext) -> str:
        return _word(not _is_true(context, self.value, self.describe()))


class AnySubstitution(Substitution):
    """True if at least one value is true (``$(any a b …)``)."""

    _combine: Any = staticmethod(any)

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self.values = [Parts.of(value) for value in args]

    def perform(self, context: LaunchContext) -> str:
        # A list: an invalid value is an error, wherever it is.
        values = [_is_true(context, v, self.describe()) for v in self.values]
        return _word(self._combine(values))

    def describe(self) -> str:
        listed = ", ".join(part.describe() for part in self.values)
        return f"{type(self).__name__}({listed})"


class AllSubstitution(AnySubstitution):
    """True if all values are true (``$(all a b …)``)."""

    _combine = staticmethod(all)


class OrSubstitution(AnySubstitution):
    """True if one of two values is true (``$(or a b)``)."""

    def __init__(
        self, left: SomeSubstitutionsType, right: SomeSubstitutionsType
    ) -> None:
        super().__init__(left, right)


class AndSubstitution(AllSubstitution):
    """True if both values are true (``$(and a b)``)."""

    def __init__(
        self, left: SomeSubstitutionsType, right: SomeSubstitutionsType
    ) -> None:
        super().__init__(left, right)


class EqualsSubstitution(Substitution):
    """True if two texts are equal; booleans and numbers compare by value."""

    def __init__(self, left: Any, right: Any) -> None:
        self.left = _side(left)
        self.right = _side(right)

    def perform(self, context: LaunchContext) -> str:
        return _word(self._same(context))

    def _same(self, context: LaunchContext) -> bool:
        left = self.left.perform(context)
        right = self.right.perform(context)
        if left == right:
            return left.lower() != "nan"
        words = {left.lower(), right.lower()}
        if words in ({"true", "1"}, {"false", "0"}) or words in ({"true"}, {"false"}):
            return True
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return False

    def describe(self) -> str:
        sides = f"{self.left.describe()}, {self.right.describe()}"
        return f"{type(self).__name__}({sides})"


class NotEqualsSubstitution(EqualsSubstitution):
    """True if two texts differ (``$(not-equals a b)``)."""

    def perform(self, context: LaunchContext) -> str:
        return _word(not self._same(context))


def _side(value: Any) -> Parts:
    if value is None:
        value = ""
    if isinstance(value, bool):
        value = _word(value)
    if isinstance(value, (int, float)):
        value = str(value)
    if isinstance(value, Iterable) and not isinstance(value, str):
        return Parts(part for item in value for part in _side(item))
    return Parts.of(value)


class IfElseSubstitution(Substitution):
    """One of two texts (``$(if condition a b)``)."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if if_value == "" and else_value == "":
            raise InvalidLaunchValueError(
                "IfElseSubstitution: expected if_value or else_value"
            )
        self.condition = Parts.of(condition)
        self.if_value = Parts.of(if_value)
        self.else_value = Parts.of(else_value)

    def perform(self, context: LaunchContext) -> str:
        try:
            holds = perform_bool(context, self.condition)
        except InvalidConditionExpressionError as error:
            raise SubstitutionFailure(f"{self.describe()}: {error}") from None
        return perform_substitutions(
            context, self.if_value if holds else self.else_value
        )
