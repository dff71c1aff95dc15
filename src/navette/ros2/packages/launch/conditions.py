"""Conditions on substitutions and on launch configurations."""

import warnings
from typing import Any, Protocol

from navette.ros2.packages.launch.condition import Condition
from navette.ros2.packages.launch.errors import InvalidConditionExpressionError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
)
from navette.ros2.packages.launch.typed import parse_bool

__all__ = [
    "condition_of",
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]


class ConditionalElement(Protocol):
    """An element of a launch file that may have ``if`` or ``unless``."""

    def parts(self, name: str, /) -> Parts | None: ...

    def error(self, reason: str, /) -> Exception: ...


def condition_of(element: ConditionalElement) -> dict[str, Any]:
    """Return ``condition=`` for the attributes ``if`` and ``unless``."""
    holds, fails = element.parts("if"), element.parts("unless")
    if holds is not None and fails is not None:
        raise element.error("attributes 'if' and 'unless' are mutually exclusive")
    if holds is not None:
        return {"condition": IfCondition(holds)}
    return {} if fails is None else {"condition": UnlessCondition(fails)}


def evaluate_condition_expression(context: LaunchContext, expression: Parts) -> bool:
    """Return whether the text of the substitutions is true (``true``, ``1``).

    Raises:
        InvalidConditionExpressionError: the text is neither true nor false.
    """
    expression = Parts(expression)
    try:
        return parse_bool(expression.perform(context))
    except InvalidConditionExpressionError as error:
        raise InvalidConditionExpressionError(
            f"condition {expression.describe()}: {error}"
        ) from None


class IfCondition(Condition):
    """True if the text is true."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = Parts.of(predicate_expression)
        super().__init__(predicate=self._is_true)

    def _is_true(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self._expression)


class UnlessCondition(IfCondition):
    """True if the text is false."""

    def _is_true(self, context: LaunchContext) -> bool:
        return not super()._is_true(context)


class LaunchConfigurationEquals(Condition):
    """True if a configuration has a value; None: if it is not set."""

    def __init__(
        self,
        launch_configuration_name: str,
        expected_value: SomeSubstitutionsType | None,
    ) -> None:
        # As in ROS 2, which marks both conditions as deprecated.
        warnings.warn(
            f"{type(self).__name__} is deprecated: use IfCondition with "
            "EqualsSubstitution or NotEqualsSubstitution",
            stacklevel=2,
        )
        self._name = launch_configuration_name
        self._expected = Parts.optional(expected_value)
        super().__init__(predicate=self._equals)

    def _equals(self, context: LaunchContext) -> bool:
        value = context.launch_configurations.get(self._name)
        if isinstance(context, LaunchContext):  # tests of others pass a double
            context.known_arguments.add(self._name)
        if self._expected is None:
            return value is None
        return value == self._expected.perform(context)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """True if a configuration has another value."""

    def _equals(self, context: LaunchContext) -> bool:
        return not super()._equals(context)
