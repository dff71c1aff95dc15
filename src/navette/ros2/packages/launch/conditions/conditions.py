"""Conditions on substitutions and on launch arguments."""

from typing import Any

from navette.ros2.packages.launch.condition import Condition
from navette.ros2.packages.launch.errors import InvalidConditionExpressionError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    describe_parts,
    normalize_to_list_of_substitutions,
    optional_parts,
    perform_substitutions,
)
from navette.ros2.packages.launch.typed import truth


def evaluate_condition_expression(context: LaunchContext, expression: Parts) -> bool:
    """Whether the text of the substitutions is true (``true``, ``1``) or false.

    Raises:
        InvalidConditionExpressionError: neither; shows what was evaluated.
    """
    text = perform_substitutions(context, expression)
    try:
        return truth(text)
    except InvalidConditionExpressionError as error:
        raise InvalidConditionExpressionError(
            f"condition {describe_parts(expression)}: {error}"
        ) from None


class IfCondition(Condition):
    """Holds where the text is true."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=self._is_true)

    def _is_true(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self._expression)


class UnlessCondition(IfCondition):
    """Holds where the text is false."""

    def _is_true(self, context: LaunchContext) -> bool:
        return not super()._is_true(context)


class LaunchConfigurationEquals(Condition):
    """Holds where an argument has a value; None: where it is not set."""

    def __init__(
        self,
        launch_configuration_name: str,
        expected_value: SomeSubstitutionsType | None,
    ) -> None:
        self._name = launch_configuration_name
        self._expected: Any = optional_parts(expected_value)
        super().__init__(predicate=self._equals)

    def _equals(self, context: LaunchContext) -> bool:
        value = context.launch_configurations.get(self._name)
        context.known_arguments.add(self._name)
        if self._expected is None:
            return value is None
        return value == perform_substitutions(context, self._expected)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds where an argument has another value."""

    def _equals(self, context: LaunchContext) -> bool:
        return not super()._equals(context)
