"""Message filters: ``--filter "m.pose.position.x > 1"``."""

from collections.abc import Callable
from typing import Any

from navette.msgs.expressions import Expression


def message_filter(text: str | None) -> Callable[[Any], bool]:
    """Return a predicate on messages (``m`` in the text); without text, always true.

    Raises:
        ExpressionError: the expression is wrong or exceeds the bounds of
            :class:`~navette.msgs.expressions.Expression`.
    """
    if text is None:
        return lambda _: True
    expression = Expression(text, names=("m",))
    return lambda message: bool(expression.value({"m": message}))
