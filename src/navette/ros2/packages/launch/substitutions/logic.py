"""Substitutions that are ``true`` or ``false``, or choose by it."""

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
    describe_parts,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from navette.ros2.packages.launch.typed import truth


def _word(value: bool) -> str:
    return "true" if value else "false"


def _is_true(context: LaunchContext, parts: Parts, what: str) -> bool:
    try:
        return truth(perform_substitutions(context, parts))
    except InvalidConditionExpressionError as error:
        raise SubstitutionFailure(f"{what}: {error}") from None


class NotSubstitution(Substitution):
    """The opposite (``$(not x)``)."""

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = normalize_to_list_of_substitutions(value)

    def perform(self, context: LaunchContext) -> str:
        return _word(not _is_true(context, self.value, self.describe()))

    def describe(self) -> str:
        return f"NotSubstitution({describe_parts(self.value)})"


class AnySubstitution(Substitution):
    """Whether at least one is true (``$(any a b …)``)."""

    _combine: Any = staticmethod(any)

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        if not args:
            raise InvalidLaunchValueError(f"{type(self).__name__}: nothing given")
        self.values = [normalize_to_list_of_substitutions(value) for value in args]

    def perform(self, context: LaunchContext) -> str:
        return _word(
            self._combine(_is_true(context, v, self.describe()) for v in self.values)
        )

    def describe(self) -> str:
        listed = ", ".join(map(describe_parts, self.values))
        return f"{type(self).__name__}({listed})"


class AllSubstitution(AnySubstitution):
    """Whether every one is true (``$(all a b …)``)."""

    _combine = staticmethod(all)


class OrSubstitution(AnySubstitution):
    """Whether one of two is true (``$(or a b)``)."""

    def __init__(
        self, left: SomeSubstitutionsType, right: SomeSubstitutionsType
    ) -> None:
        super().__init__(left, right)


class AndSubstitution(AllSubstitution):
    """Whether both are true (``$(and a b)``)."""

    def __init__(
        self, left: SomeSubstitutionsType, right: SomeSubstitutionsType
    ) -> None:
        super().__init__(left, right)


class EqualsSubstitution(Substitution):
    """Whether two texts are the same; truths and numbers by value."""

    def __init__(self, left: Any, right: Any) -> None:
        self.left = _side(left)
        self.right = _side(right)

    def perform(self, context: LaunchContext) -> str:
        return _word(self._same(context))

    def _same(self, context: LaunchContext) -> bool:
        left = perform_substitutions(context, self.left)
        right = perform_substitutions(context, self.right)
        if left == right:
            return True
        words = {left.lower(), right.lower()}
        if words in ({"true", "1"}, {"false", "0"}) or words in ({"true"}, {"false"}):
            return True
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return False

    def describe(self) -> str:
        sides = f"{describe_parts(self.left)}, {describe_parts(self.right)}"
        return f"{type(self).__name__}({sides})"


class NotEqualsSubstitution(EqualsSubstitution):
    """Whether two texts differ (``$(not-equals a b)``)."""

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
        return [part for item in value for part in _side(item)]
    return normalize_to_list_of_substitutions(value)


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
                "IfElseSubstitution: neither if_value nor else_value is given"
            )
        self.condition = normalize_to_list_of_substitutions(condition)
        self.if_value = normalize_to_list_of_substitutions(if_value)
        self.else_value = normalize_to_list_of_substitutions(else_value)

    def perform(self, context: LaunchContext) -> str:
        holds = _is_true(context, self.condition, self.describe())
        return perform_substitutions(
            context, self.if_value if holds else self.else_value
        )

    def describe(self) -> str:
        return f"IfElseSubstitution({describe_parts(self.condition)})"
