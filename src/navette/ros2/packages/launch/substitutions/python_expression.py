"""Substitution of a Python expression."""

from importlib import import_module

from navette.msgs.expressions import (
    Expression,
    ExpressionError,
    ModuleNames,
    UnknownExpressionNameError,
)
from navette.ros2.packages.launch.errors import SubstitutionFailure
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    Substitution,
)

_HINT = "for more than an expression, use OpaqueFunction in a Python launch file"


class UnknownVariableError(SubstitutionFailure, NameError):
    """An expression contains a name that it does not have."""


class PythonExpression(Substitution):
    """Value of a Python expression (``$(eval '1 + 1')``).

    Expressions are bounded: see :mod:`navette.msgs.expressions`.

    Args:
        expression: parts of the expression.
        python_modules: modules that it uses, by default ``math``; in one text, they are
            separated by commas.
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

    def describe(self) -> str:
        modules = ", ".join(part.describe() for part in self.python_modules)
        return f"PythonExpr({self.expression.describe()}, [{modules}])"

    def perform(self, context: LaunchContext) -> str:
        given = ",".join(part.perform(context) for part in self.python_modules)
        modules = {}
        for name in filter(None, (word.strip() for word in given.split(","))):
            try:
                modules[name] = ModuleNames(import_module(name))
            except ImportError as error:
                raise SubstitutionFailure(f"{self.describe()}: {error}") from error
        has_math = modules.pop("math", None) is not None  # the bounded functions
        try:
            text = self.expression.perform(context)
            expression = Expression(text, names=modules, hint=_HINT, with_math=has_math)
            return str(expression.value(modules))
        except UnknownExpressionNameError as error:
            raise UnknownVariableError(str(error)) from None
        except ExpressionError as error:
            raise SubstitutionFailure(str(error)) from None
