"""Substitution of a Python expression."""

from navette.msgs.expressions import ExpressionError, evaluate
from navette.ros2.packages.launch.errors import SubstitutionFailure
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    Substitution,
)

_MODULES = ("math",)
_HINT = "for more than an expression, use OpaqueFunction in a Python launch file"


class PythonExpression(Substitution):
    """Value of a Python expression (``$(eval '1 + 1')``).

    Expressions are bounded: see :mod:`navette.msgs.expressions`.

    Args:
        expression: parts of the expression.
        python_modules: modules that it uses; only ``math`` is available.
    """

    def __init__(
        self,
        expression: SomeSubstitutionsType,
        python_modules: SomeSubstitutionsType = ("math",),
    ) -> None:
        self.expression = Parts.of(expression)
        modules = (
            [python_modules] if isinstance(python_modules, str) else python_modules
        )
        self.python_modules = Parts.of(modules)

    def perform(self, context: LaunchContext) -> str:
        for part in self.python_modules:
            module = part.perform(context)
            if module not in _MODULES:
                raise SubstitutionFailure(
                    f"PythonExpression: module {module!r} is not available in "
                    f"expressions; available: {', '.join(_MODULES)}"
                )
        try:
            text = self.expression.perform(context)
            return str(evaluate(text, _HINT))
        except ExpressionError as error:
            raise SubstitutionFailure(str(error)) from None
