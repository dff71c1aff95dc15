"""Search of expected output in the output of a process."""

import re
from collections.abc import Callable, Iterable
from typing import Any

_ANSI = re.compile(r"\x1b\[[0-9;]*[a-zA-Z]")


def without_colours(text: str) -> str:
    """Return a text without the escape sequences of terminals."""
    return _ANSI.sub("", text)


def make_matcher(expected: Any) -> Callable[[str], bool]:
    """Return a function that checks whether a text contains what is expected.

    Args:
        expected: a text, a compiled pattern, a list of these for parts in this order,
            or a function of the text.

    Raises:
        ValueError: anything else.
    """
    if callable(expected):
        return lambda text: bool(expected(text))
    items = expected if isinstance(expected, (list, tuple)) else [expected]
    for item in items:
        if not isinstance(item, (str, re.Pattern)):
            raise ValueError(
                f"expected output {item!r}: expected text, a pattern, a list of these "
                "or a function"
            )
    return lambda text: _contains_in_order(text, items)


def _contains_in_order(text: str, items: Iterable[Any]) -> bool:
    position = 0
    for item in items:
        pattern = re.compile(re.escape(item)) if isinstance(item, str) else item
        found = pattern.search(text, position)
        if found is None:
            return False
        position = found.end()
    return True
