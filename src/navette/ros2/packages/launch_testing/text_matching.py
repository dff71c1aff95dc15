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


def text_matches(text: str, expected: Any, *, strict: bool = False) -> bool:
    """Whether a text contains what is expected; ``strict``: from its start on.

    Args:
        expected: a text (``strict``: the whole), a pattern, or a list of these for
            parts in this order (``strict``: without anything between them).
    """
    text = text.replace("\r\n", "\n")
    if isinstance(expected, str):
        return text == expected if strict else expected in text
    position = 0
    for item in expected if isinstance(expected, (list, tuple)) else [expected]:
        pattern = re.compile(re.escape(item)) if isinstance(item, str) else item
        found = pattern.search(text, position)
        if found is None or (strict and found.start() != position):
            return False
        position = found.end()
    return True


def lines_match(lines: list[str], expected: Any, *, strict: bool = False) -> bool:
    """Whether lines contain what is expected.

    Args:
        expected: a part of a line, a pattern of its start (``strict``: all lines are
            so), or a list of these for lines in this order (``strict``: from the first
            line on, without lines between them).
    """
    if not isinstance(expected, (list, tuple)):
        if not strict:
            return any(_line_has(line, expected) for line in lines)
        is_text = isinstance(expected, str)
        return all(
            line == expected if is_text else expected.match(line) for line in lines
        )
    position = 0
    for item in expected:
        rest = range(position, len(lines))
        at = next((i for i in rest if _line_has(lines[i], item)), None)
        if at is None or (strict and at != position):
            return False
        position = at + 1
    return True


def _line_has(line: str, expected: Any) -> bool:
    if isinstance(expected, str):
        return expected in line
    return expected.match(line) is not None
