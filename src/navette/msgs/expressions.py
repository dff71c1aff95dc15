"""Python expressions over messages, evaluated by simpleeval instead of ``eval``.

Expressions come from command lines and launch files of others. They calculate, compare
and choose, but reach nothing outside themselves, and their values and running time are
bounded. The bounds below close what simpleeval leaves open: products and powers of
large integers, text built by ``replace``, ``join`` and ``str``, f-strings with a width.
"""

import ast
import math
from array import array
from collections.abc import Callable, Collection, Iterable
from functools import cache, partial
from types import ModuleType
from typing import Any

from simpleeval import DEFAULT_OPERATORS, EvalWithCompoundTypes, InvalidExpression

from navette.errors import InvalidValueError, NavetteError
from navette.msgs.base import Message

MAX_LENGTH = 10_000  # characters of an expression
MAX_ITEMS = 100_000  # characters or elements of a value
MAX_BITS = 4096  # of an integer
MAX_LOOP_PARTS = 60  # syntax nodes of a comprehension; simpleeval bounds its rounds
_MAX_DIGITS = 1000

_SEQUENCES = (str, bytes, list, tuple, array)


class ModuleNames:
    """The public names of a module, for an expression that may use all of them."""

    def __init__(self, module: ModuleType) -> None:
        self._module = module
        self.names = [name for name in dir(module) if not name.startswith("_")]

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._module, name)
        return ModuleNames(value) if isinstance(value, ModuleType) else value


class ExpressionError(InvalidValueError):
    """An expression is malformed, fails, or exceeds a bound."""


class UnknownExpressionNameError(ExpressionError):
    """An expression contains a name that it was not given."""


class Expression:
    """An expression over given names, parsed once and evaluated many times.

    Available beside the names: the functions of ``math`` (also as ``math.…``), Python's
    simple types, ``abs all any len max min round sorted sum``, ``true``, ``false``,
    the public names of given :class:`ModuleNames`, the methods of ``str`` that return
    bounded text, the fields and constants of messages, and
    comprehensions of at most 10,000 rounds.

    Args:
        text: the expression.
        names: the names that :meth:`value` will receive.
        hint: advice that is appended to the error for syntax that is not allowed.
        with_math: the functions of ``math`` are available.

    Raises:
        ExpressionError: syntax, a name or an operator that is not allowed.
    """

    def __init__(
        self,
        text: str,
        *,
        names: Collection[str] = (),
        hint: str = "",
        with_math: bool = True,
    ) -> None:
        if len(text) > MAX_LENGTH:
            raise ExpressionError(
                f"expression of {len(text)} characters; at most {MAX_LENGTH} allowed"
            )
        self.text = text
        self._functions = _FUNCTIONS if with_math else _WITHOUT_MATH
        self._evaluator = _make_evaluator(self._functions)
        try:
            self._tree = ast.parse(text.strip(), mode="eval").body
            self._check_syntax(hint)
            self._check_names(names)
        except SyntaxError as error:
            raise self._error(error.msg) from None
        except (RecursionError, MemoryError):
            raise ExpressionError("expression is nested too deeply") from None

    def value(self, names: dict[str, Any] | None = None) -> Any:
        """Return the value for the given names.

        Args:
            names: value of each name; a subclass with ``__missing__`` may compute them
                when they are needed.

        Raises:
            ExpressionError: the evaluation fails or exceeds a bound.
        """
        self._evaluator.names = {} if names is None else names
        try:
            return self._evaluator.eval(self.text, self._tree)
        except (RecursionError, MemoryError):
            raise ExpressionError("expression is nested too deeply") from None
        except (ExpressionError, InvalidExpression) as error:
            raise self._error(str(error)) from None
        except NavetteError:  # of a name that is computed when it is needed
            raise
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            raise self._error(f"{type(error).__name__}: {error}") from None

    def _check_syntax(self, hint: str) -> None:
        for node in ast.walk(self._tree):
            kind = type(node)
            if isinstance(node, ast.expr):
                allowed = kind in self._evaluator.nodes
            elif isinstance(node, (ast.operator, ast.unaryop, ast.cmpop)):
                allowed = kind in _OPERATORS
            else:
                continue
            if not allowed:
                part = ast.unparse(node) or kind.__name__
                advice = f"; {hint}" if hint else ""
                raise self._error(f"{part!r} ({kind.__name__}) is not allowed{advice}")
            if isinstance(node, (ast.ListComp, ast.SetComp, ast.GeneratorExp)):
                parts = sum(isinstance(each, ast.expr) for each in ast.walk(node))
                if parts > MAX_LOOP_PARTS:
                    raise self._error(
                        f"a comprehension of {parts} parts; at most {MAX_LOOP_PARTS}"
                    )

    def _check_names(self, given: Collection[str]) -> None:
        names = [node for node in ast.walk(self._tree) if isinstance(node, ast.Name)]
        loop_variables = {each.id for each in names if isinstance(each.ctx, ast.Store)}
        for each in sorted({node.id for node in names} - loop_variables):
            if each not in given and each not in self._functions:
                math_name = ["math"] if "math" in self._functions else []
                known = ", ".join([*given, *math_name, *sorted(_PLAIN_FUNCTIONS)])
                raise UnknownExpressionNameError(
                    f"expression {self.text!r}: unknown name {each!r} (text needs "
                    f"quotes inside the expression); known: {known}"
                )

    def _error(self, reason: str) -> ExpressionError:
        return ExpressionError(f"expression {self.text!r}: {reason}")


def _make_evaluator(functions: dict[str, Any]) -> Any:
    evaluator = EvalWithCompoundTypes(operators=_OPERATORS, functions={})
    evaluator.functions = functions
    nodes = evaluator.nodes
    # f-strings take a width, for text of any length.
    for kind in (ast.JoinedStr, ast.FormattedValue, ast.DictComp):
        del nodes[kind]
    loop = nodes[ast.ListComp]
    nodes[ast.SetComp] = lambda node: set(loop(node))
    nodes[ast.Attribute] = lambda node: _attribute(
        evaluator._eval(node.value), node.attr
    )
    return evaluator


def _attribute(owner: Any, name: str) -> Any:
    if owner is _MATH and name in _MATH:
        return _MATH[name]
    kind: Any = type(owner)
    allowed: Collection[str] = _MATH if owner is _MATH else _METHODS.get(kind, ())
    if isinstance(owner, Message):
        allowed = _members(kind)
    elif kind is ModuleNames:
        allowed = owner.names
    if name not in allowed:
        owner_name = "math" if owner is _MATH else kind.__name__
        raise ExpressionError(
            f"attribute {name!r} of {owner_name} is not available; available: "
            f"{', '.join(sorted(allowed)) or 'none'}"
        )
    if kind is str and name in _BOUNDED_METHODS:
        return partial(_BOUNDED_METHODS[name], owner)
    return getattr(owner, name)


@cache
def _members(cls: type[Message]) -> frozenset[str]:
    """Names of the fields and constants of a message class."""
    return frozenset(cls._field_types_) | {each.name for each in cls._spec_.constants}


def _check_items(count: int) -> None:
    if count > MAX_ITEMS:
        raise ExpressionError(f"a value of more than {MAX_ITEMS} items")


def _check_bits(count: int) -> None:
    if count > MAX_BITS:
        raise ExpressionError(f"an integer of more than {MAX_BITS} bits")


def _multiply(left: Any, right: Any) -> Any:
    if isinstance(left, int) and isinstance(right, int):
        _check_bits(left.bit_length() + right.bit_length())
    for items, count in ((left, right), (right, left)):
        if isinstance(items, _SEQUENCES) and isinstance(count, int):
            _check_items(len(items) * count)
    return left * right


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int) and isinstance(exponent, int):
        _check_bits(base.bit_length() * max(exponent, 0))
    return base**exponent


def _modulo(left: Any, right: Any) -> Any:
    if isinstance(left, (str, bytes)):
        raise ExpressionError("'%' on text is not allowed; use + and str()")
    return left % right


def _replace(text: str, old: str, new: str, count: int = -1) -> str:
    _check_items((len(text) + 1) * (len(new) + 1))
    return text.replace(old, new, count)


def _join(separator: str, parts: Iterable[str]) -> str:
    parts = list(parts)
    _check_items(sum(map(len, parts)) + len(separator) * len(parts))
    return separator.join(parts)


def _str(value: Any = "") -> str:
    text = str(value)
    _check_items(len(text))
    return text


def _sum(items: Iterable[Any], start: float = 0) -> Any:
    """``sum`` of numbers only: concatenating lists takes quadratic time."""
    if not isinstance(start, (int, float)):
        raise ExpressionError("sum() adds numbers only")
    return sum(items, start)


def _round(number: Any, digits: int | None = None) -> Any:
    """``round`` without intermediate integers of a billion digits."""
    if digits is not None and abs(digits) > _MAX_DIGITS:
        raise ExpressionError(f"round() to more than {_MAX_DIGITS} digits")
    return round(number, digits)


_OPERATORS = {
    kind: function
    for kind, function in DEFAULT_OPERATORS.items()
    if kind not in (ast.LShift, ast.RShift)
}
_OPERATORS |= {ast.Mult: _multiply, ast.Pow: _power, ast.Mod: _modulo}

_PLAIN_FUNCTIONS: dict[str, Callable[..., Any]] = {
    each.__name__: each
    for each in (abs, all, any, bool, dict, float, int, len, list, max, min, set)
}
_PLAIN_FUNCTIONS |= {"sorted": sorted, "tuple": tuple, "str": _str}
_PLAIN_FUNCTIONS |= {"round": _round, "sum": _sum}
# The results of these grow without bound.
_GROWING = {"factorial", "comb", "perm", "prod", "lcm", "sumprod"}
_MATH: dict[str, Any] = {
    name: getattr(math, name)
    for name in dir(math)
    if name[0] != "_" and name not in _GROWING
}
# simpleeval looks names up here after the names that the user gave.
_FUNCTIONS: dict[str, Any] = {"math": _MATH, "true": True, "false": False}
_FUNCTIONS |= {**_MATH, **_PLAIN_FUNCTIONS}
_WITHOUT_MATH = {"true": True, "false": False, **_PLAIN_FUNCTIONS}

_BOUNDED_METHODS: dict[str, Callable[..., str]] = {"join": _join, "replace": _replace}
_METHODS: dict[type, frozenset[str]] = {
    str: frozenset(
        "capitalize casefold count endswith find index isalnum isalpha isdigit "
        "islower isnumeric isspace isupper join lower lstrip partition removeprefix "
        "removesuffix replace rfind rpartition rsplit rstrip split splitlines "
        "startswith strip swapcase title upper".split()
    ),
    list: frozenset({"count", "index"}),
    tuple: frozenset({"count", "index"}),
    dict: frozenset({"get", "items", "keys", "values"}),
    float: frozenset({"is_integer"}),
}
