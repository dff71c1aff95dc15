"""``--filter "m.pose.position.x > 1"``: which messages count."""

from collections.abc import Callable, Collection
from functools import cache
from typing import Any

from navette.expressions import Expression
from navette.msgs import Message


def message_filter(text: str | None) -> Callable[[Any], bool]:
    """Whether a message (``m``) is one to look at; every one without a text.

    Raises:
        ExpressionError: the expression is wrong, or asks too much (see
            :class:`~navette.expressions.Expression`).
    """
    if text is None:
        return lambda _: True
    expression = Expression(text, names=("m",), fields=_fields)
    return lambda message: bool(expression.value(m=message))


def _fields(owner: Any) -> Collection[str]:
    kind: Any = type(owner)
    return _names(kind) if isinstance(owner, Message) else ()


@cache
def _names(cls: Any) -> frozenset[str]:
    return frozenset(cls._field_types_) | {c.name for c in cls._spec_.constants}
