"""Python expressions of launch files, worked out without Python's ``eval``.

Launch files in YAML and XML come from strangers: an expression may calculate,
compare, choose and format, but reach nothing outside itself, and neither its result
nor its work can grow without bound.
"""

import ast
import math
import operator
from collections.abc import Callable
from typing import Any

from navette.errors import InvalidValueError

MAX_LENGTH = 10_000
MAX_SIZE = 100_000
MAX_BITS = 4096


class ExpressionError(InvalidValueError):
    """An expression is wrong, or asks for more than expressions may."""


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    f.__name__: f
    for f in (abs, all, any, bool, float, int, len, list, max, min, round, sorted)
} | {"str": str, "sum": sum, "tuple": tuple, "dict": dict, "set": set}
_MATH = {
    name: getattr(math, name)
    for name in dir(math)
    if name[0] != "_" and name not in ("factorial", "comb", "perm")
}
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
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: operator.not_,
    ast.Invert: operator.invert,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda item, holder: item in holder,
    ast.NotIn: lambda item, holder: item not in holder,
}


def evaluate(text: str) -> Any:
    """The value of an expression.

    Names: the functions of ``math`` (also as ``math.…``), Python's simple types,
    ``abs all any len max min round sorted sum``, and the words ``true``, ``false``.

    Raises:
        ExpressionError: names the expression and the part that is wrong.
    """
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"expression of {len(text)} characters; at most 10000")
    try:
        tree = ast.parse(text.strip(), mode="eval")
        return _value(tree.body)
    except ExpressionError as error:
        raise ExpressionError(f"expression {text!r}: {error}") from None
    except SyntaxError as error:
        raise ExpressionError(f"expression {text!r}: {error.msg}") from None
    except (RecursionError, MemoryError):
        raise ExpressionError("expression nested too deeply") from None
    except (ArithmeticError, LookupError, TypeError, ValueError) as error:
        kind = type(error).__name__
        raise ExpressionError(f"expression {text!r}: {kind}: {error}") from None


def _value(node: ast.expr) -> Any:
    worker = _WORKERS.get(type(node))
    if worker is None:
        raise ExpressionError(
            f"{ast.unparse(node)!r} ({type(node).__name__}) is not allowed here; "
            "for more than an expression, use OpaqueFunction in a Python launch file"
        )
    return _bounded(worker(node))


def _bounded(value: Any) -> Any:
    if isinstance(value, int) and value.bit_length() > MAX_BITS:
        raise ExpressionError(f"a number of more than {MAX_BITS} bits")
    if isinstance(value, (str, bytes, list, tuple)) and len(value) > MAX_SIZE:
        raise ExpressionError(f"a value of more than {MAX_SIZE} items")
    return value


def _name(node: ast.Name) -> Any:
    names = {"math": _MATH, "true": True, "false": False, **_MATH, **_FUNCTIONS}
    if node.id not in names:
        raise ExpressionError(
            f"unknown name {node.id!r} (text needs quotes inside the expression); "
            f"known: math, {', '.join(sorted(_FUNCTIONS))}"
        )
    return names[node.id]


def _attribute(node: ast.Attribute) -> Any:
    owner = _value(node.value)
    if owner is _MATH:
        if node.attr in _MATH:
            return _MATH[node.attr]
        raise ExpressionError(f"no math.{node.attr} here")
    allowed = _METHODS.get(type(owner), frozenset())
    if node.attr in allowed:
        return getattr(owner, node.attr)
    raise ExpressionError(
        f"{ast.unparse(node)!r} is not allowed; of {type(owner).__name__}: "
        f"{', '.join(sorted(allowed)) or 'nothing'}"
    )


def _call(node: ast.Call) -> Any:
    function = _value(node.func)
    if not callable(function):
        raise ExpressionError(f"{ast.unparse(node.func)!r} cannot be called")
    arguments = [_value(argument) for argument in node.args]
    keywords = {k.arg: _value(k.value) for k in node.keywords if k.arg is not None}
    if len(keywords) != len(node.keywords):
        raise ExpressionError("'**' is not allowed")
    _check_growth(function, arguments)
    return function(*arguments, **keywords)


def _check_growth(function: Any, arguments: list[Any]) -> None:
    """``replace`` and ``join`` multiply lengths: bound them before they work."""
    owner = getattr(function, "__self__", None)
    if isinstance(owner, str) and function.__name__ in ("replace", "join"):
        lengths = [len(a) for a in arguments if isinstance(a, (str, list, tuple))]
        if (len(owner) + 1) * (max(lengths, default=0) + 1) > 10 * MAX_SIZE:
            raise ExpressionError(f"a value of more than {MAX_SIZE} items")


def _binary(node: ast.BinOp) -> Any:
    left, right = _value(node.left), _value(node.right)
    if isinstance(node.op, ast.Mod) and isinstance(left, (str, bytes)):
        raise ExpressionError("'%' on text is not allowed; use + and str()")
    if _would_be_large(node.op, left, right):
        raise ExpressionError(
            f"a value of more than {MAX_SIZE} items or {MAX_BITS} bits"
        )
    return _operator(node.op)(left, right)


def _would_be_large(operation: ast.operator, left: Any, right: Any) -> bool:
    """Whether it would take long before its result could be looked at."""
    if isinstance(operation, ast.Pow):
        whole = isinstance(left, int) and isinstance(right, int)
        return whole and left.bit_length() * max(right, 0) > MAX_BITS
    if isinstance(operation, ast.Mult):
        return any(
            isinstance(items, (str, bytes, list, tuple))
            and isinstance(count, int)
            and len(items) * count > MAX_SIZE
            for count, items in ((left, right), (right, left))
        )
    return False


def _operator(node: ast.AST) -> Callable[..., Any]:
    if type(node) not in _OPERATORS:
        raise ExpressionError(f"operator {type(node).__name__} is not allowed")
    return _OPERATORS[type(node)]


def _boolean(node: ast.BoolOp) -> Any:
    stops_at = isinstance(node.op, ast.Or)
    value: Any = None
    for operand in node.values:
        value = _value(operand)
        if bool(value) == stops_at:
            return value
    return value


def _compare(node: ast.Compare) -> bool:
    left = _value(node.left)
    for step, operand in zip(node.ops, node.comparators, strict=True):
        right = _value(operand)
        if not _operator(step)(left, right):
            return False
        left = right
    return True


def _dictionary(node: ast.Dict) -> dict[Any, Any]:
    if None in node.keys:
        raise ExpressionError("'**' is not allowed")
    return {
        _value(key): _value(value)
        for key, value in zip(node.keys, node.values, strict=True)
        if key is not None
    }


def _slice(node: ast.Slice) -> slice:
    ends = (node.lower, node.upper, node.step)
    return slice(*(None if end is None else _value(end) for end in ends))


_WORKERS: dict[type[ast.AST], Callable[[Any], Any]] = {
    ast.Constant: lambda node: node.value,
    ast.Name: _name,
    ast.Attribute: _attribute,
    ast.Call: _call,
    ast.BinOp: _binary,
    ast.UnaryOp: lambda node: _operator(node.op)(_value(node.operand)),
    ast.BoolOp: _boolean,
    ast.Compare: _compare,
    ast.IfExp: lambda node: _value(node.body if _value(node.test) else node.orelse),
    ast.Subscript: lambda node: _value(node.value)[_value(node.slice)],
    ast.Slice: _slice,
    ast.List: lambda node: [_value(item) for item in node.elts],
    ast.Tuple: lambda node: tuple(_value(item) for item in node.elts),
    ast.Set: lambda node: {_value(item) for item in node.elts},
    ast.Dict: _dictionary,
}
