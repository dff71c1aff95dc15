"""Python expressions of launch files and filters, without Python's ``eval``.

Such expressions come from strangers: one may calculate, compare, choose and format,
but reach nothing outside itself, and neither its result nor its work can grow without
bound.
"""

import ast
import math
import operator
from array import array
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import Any

from navette.errors import InvalidValueError

MAX_LENGTH = 10_000
MAX_SIZE = 100_000
MAX_BITS = 4096
MAX_STEPS = 1_000_000
_MAX_DIGITS = 1000


class ExpressionError(InvalidValueError):
    """An expression is wrong, or asks for more than expressions may."""


def _sum(items: Iterable[Any], start: float = 0) -> Any:
    """``sum`` of numbers: adding up lists would take quadratic time."""
    if not isinstance(start, (int, float)):
        raise ExpressionError("sum() adds numbers")
    return sum(items, start)


def _round(number: Any, digits: int | None = None) -> Any:
    """``round`` that makes no number of a billion digits on the way."""
    if digits is not None and abs(digits) > _MAX_DIGITS:
        raise ExpressionError(f"round() to more than {_MAX_DIGITS} digits")
    return round(number, digits)


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    f.__name__: f
    for f in (abs, all, any, bool, float, int, len, list, max, min, sorted)
}
_FUNCTIONS |= {"dict": dict, "set": set, "str": str, "tuple": tuple}
_FUNCTIONS |= {"round": _round, "sum": _sum}
_MATH = {
    name: getattr(math, name)
    for name in dir(math)
    if name[0] != "_" and name not in ("factorial", "comb", "perm", "prod")
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


_WORDS: dict[str, Any] = {"math": _MATH, "true": True, "false": False}
_WORDS |= {**_MATH, **_FUNCTIONS}

Fields = Callable[[Any], Collection[str]]
"""Names that may be taken of an object with a dot."""


def evaluate(text: str, hint: str = "") -> Any:
    """The value of an expression that stands for itself: see :class:`Expression`."""
    return Expression(text, hint=hint).value()


class Expression:
    """An expression over the names that its user gives.

    Beside those: the functions of ``math`` (also as ``math.…``), Python's simple
    types, ``abs all any len max min round sorted sum``, and ``true``, ``false``.

    Args:
        names: what :meth:`value` will be given.
        fields: what may be taken of an object that is none of Python's own.
        hint: what to do instead, for who asks too much.

    Raises:
        ExpressionError: names the expression and the part that is wrong.
    """

    def __init__(
        self,
        text: str,
        *,
        names: Collection[str] = (),
        fields: Fields = lambda _: (),
        hint: str = "",
    ) -> None:
        if len(text) > MAX_LENGTH:
            raise ExpressionError(
                f"expression of {len(text)} characters; at most {MAX_LENGTH}"
            )
        self.text = text
        self._fields = fields
        try:
            self._tree = ast.parse(text.strip(), mode="eval").body
            _check_parts(self._tree, hint)
            _check_names(self._tree, names)
        except ExpressionError as error:
            raise ExpressionError(f"expression {text!r}: {error}") from None
        except SyntaxError as error:
            raise ExpressionError(f"expression {text!r}: {error.msg}") from None
        except (RecursionError, MemoryError):
            raise ExpressionError("expression nested too deeply") from None

    def value(self, **names: Any) -> Any:
        """What it comes to.

        Raises:
            ExpressionError: it cannot be worked out, or not within bounds.
        """
        try:
            return _Evaluation(names, self._fields).value(self._tree)
        except ExpressionError as error:
            raise ExpressionError(f"expression {self.text!r}: {error}") from None
        except (RecursionError, MemoryError):
            raise ExpressionError("expression nested too deeply") from None
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            kind = type(error).__name__
            raise ExpressionError(
                f"expression {self.text!r}: {kind}: {error}"
            ) from None


def _check_parts(tree: ast.expr, hint: str) -> None:
    for node in ast.walk(tree):
        if isinstance(node, ast.expr) and type(node) not in _WORKERS:
            raise ExpressionError(
                f"{ast.unparse(node)!r} ({type(node).__name__}) is not allowed here"
                + (f"; {hint}" if hint else "")
            )


def _check_names(tree: ast.expr, given: Collection[str]) -> None:
    names = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
    own = {node.id for node in names if isinstance(node.ctx, ast.Store)}
    for node in names:
        if node.id not in own and node.id not in given and node.id not in _WORDS:
            known = ", ".join([*given, "math", *sorted(_FUNCTIONS)])
            raise ExpressionError(
                f"unknown name {node.id!r} (text needs quotes inside the expression); "
                f"known: {known}"
            )


class _Evaluation:
    """One working out: its names and the steps that are left."""

    def __init__(self, names: Mapping[str, Any], fields: Fields) -> None:
        self.names = dict(names)
        self.fields = fields
        self._steps_left = MAX_STEPS

    def value(self, node: ast.expr) -> Any:
        self._steps_left -= 1
        if self._steps_left < 0:
            raise ExpressionError(f"more than {MAX_STEPS} steps")
        return _WORKERS[type(node)](self, node)

    def values(self, nodes: Iterable[ast.expr]) -> list[Any]:
        return [self.value(node) for node in nodes]


def _bounded(value: Any) -> Any:
    if isinstance(value, int) and value.bit_length() > MAX_BITS:
        raise ExpressionError(f"a number of more than {MAX_BITS} bits")
    if isinstance(value, (str, bytes, list, tuple, array)) and len(value) > MAX_SIZE:
        raise ExpressionError(f"a value of more than {MAX_SIZE} items")
    return value


def _name(work: _Evaluation, node: ast.Name) -> Any:
    if node.id in work.names:
        return work.names[node.id]
    if node.id not in _WORDS:  # of a comprehension that is not entered yet
        raise ExpressionError(f"{node.id!r} has no value here")
    return _WORDS[node.id]


def _attribute(work: _Evaluation, node: ast.Attribute) -> Any:
    owner = work.value(node.value)
    if owner is _MATH:
        if node.attr in _MATH:
            return _MATH[node.attr]
        raise ExpressionError(f"no math.{node.attr} here")
    allowed = _METHODS.get(type(owner)) or work.fields(owner)
    if node.attr in allowed:
        return getattr(owner, node.attr)
    raise ExpressionError(
        f"{ast.unparse(node)!r} is not allowed; of {type(owner).__name__}: "
        f"{', '.join(sorted(allowed)) or 'nothing'}"
    )


def _call(work: _Evaluation, node: ast.Call) -> Any:
    function = work.value(node.func)
    if not callable(function):
        raise ExpressionError(f"{ast.unparse(node.func)!r} cannot be called")
    arguments = work.values(node.args)
    keywords = {k.arg: work.value(k.value) for k in node.keywords if k.arg is not None}
    if len(keywords) != len(node.keywords):
        raise ExpressionError("'**' is not allowed")
    _check_growth(function, arguments)
    return _bounded(function(*arguments, **keywords))


def _check_growth(function: Any, arguments: list[Any]) -> None:
    """``replace`` and ``join`` multiply lengths: bound them before they work."""
    owner = getattr(function, "__self__", None)
    if isinstance(owner, str) and function.__name__ in ("replace", "join"):
        lengths = [len(a) for a in arguments if isinstance(a, (str, list, tuple))]
        if (len(owner) + 1) * (max(lengths, default=0) + 1) > 10 * MAX_SIZE:
            raise ExpressionError(f"a value of more than {MAX_SIZE} items")


def _binary(work: _Evaluation, node: ast.BinOp) -> Any:
    left, right = work.value(node.left), work.value(node.right)
    if isinstance(node.op, ast.Mod) and isinstance(left, (str, bytes)):
        raise ExpressionError("'%' on text is not allowed; use + and str()")
    if _would_be_large(node.op, left, right):
        raise ExpressionError(
            f"a value of more than {MAX_SIZE} items or {MAX_BITS} bits"
        )
    return _bounded(_operator(node.op)(left, right))


def _would_be_large(operation: ast.operator, left: Any, right: Any) -> bool:
    """Whether it would take long before its result could be looked at."""
    if isinstance(operation, ast.Pow):
        whole = isinstance(left, int) and isinstance(right, int)
        return whole and left.bit_length() * max(right, 0) > MAX_BITS
    if isinstance(operation, ast.Mult):
        return any(
            isinstance(items, (str, bytes, list, tuple, array))
            and isinstance(count, int)
            and len(items) * count > MAX_SIZE
            for count, items in ((left, right), (right, left))
        )
    return False


def _operator(node: ast.AST) -> Callable[..., Any]:
    if type(node) not in _OPERATORS:
        raise ExpressionError(f"operator {type(node).__name__} is not allowed")
    return _OPERATORS[type(node)]


def _boolean(work: _Evaluation, node: ast.BoolOp) -> Any:
    stops_at = isinstance(node.op, ast.Or)
    value: Any = None
    for operand in node.values:
        value = work.value(operand)
        if bool(value) == stops_at:
            return value
    return value


def _compare(work: _Evaluation, node: ast.Compare) -> bool:
    left = work.value(node.left)
    for step, operand in zip(node.ops, node.comparators, strict=True):
        right = work.value(operand)
        if not _operator(step)(left, right):
            return False
        left = right
    return True


def _dictionary(work: _Evaluation, node: ast.Dict) -> dict[Any, Any]:
    if None in node.keys:
        raise ExpressionError("'**' is not allowed")
    return {
        work.value(key): work.value(value)
        for key, value in zip(node.keys, node.values, strict=True)
        if key is not None
    }


def _slice(work: _Evaluation, node: ast.Slice) -> slice:
    ends = (node.lower, node.upper, node.step)
    return slice(*(None if end is None else work.value(end) for end in ends))


def _comprehended(
    work: _Evaluation, node: ast.ListComp | ast.SetComp | ast.GeneratorExp
) -> list[Any]:
    """What ``f(x) for x in xs if …`` gives; at once, so that its names end with it."""
    outside = dict(work.names)
    found: list[Any] = []
    for _ in _bindings(work, node.generators):
        found.append(work.value(node.elt))
        _bounded(found)
    work.names = outside
    return found


def _bindings(work: _Evaluation, loops: list[ast.comprehension]) -> Iterator[None]:
    if not loops:
        yield
        return
    loop, *inner = loops
    if not isinstance(loop.target, ast.Name):
        raise ExpressionError(
            f"{ast.unparse(loop.target)!r}: a loop has one simple name here"
        )
    for item in work.value(loop.iter):
        work.names[loop.target.id] = item
        if all(work.value(condition) for condition in loop.ifs):
            yield from _bindings(work, inner)


_WORKERS: dict[type[ast.AST], Callable[[_Evaluation, Any], Any]] = {
    ast.Constant: lambda work, node: node.value,
    ast.Name: _name,
    ast.Attribute: _attribute,
    ast.Call: _call,
    ast.BinOp: _binary,
    ast.UnaryOp: lambda work, node: _operator(node.op)(work.value(node.operand)),
    ast.BoolOp: _boolean,
    ast.Compare: _compare,
    ast.IfExp: lambda work, node: work.value(
        node.body if work.value(node.test) else node.orelse
    ),
    ast.Subscript: lambda work, node: work.value(node.value)[work.value(node.slice)],
    ast.Slice: _slice,
    ast.List: lambda work, node: work.values(node.elts),
    ast.Tuple: lambda work, node: tuple(work.values(node.elts)),
    ast.Set: lambda work, node: set(work.values(node.elts)),
    ast.Dict: _dictionary,
    ast.ListComp: _comprehended,
    ast.GeneratorExp: _comprehended,
    ast.SetComp: lambda work, node: set(_comprehended(work, node)),
}
