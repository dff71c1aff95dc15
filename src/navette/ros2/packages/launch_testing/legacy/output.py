"""Tests and filters of the output of a process, as bytes."""

import re
from collections.abc import Callable, Iterable
from io import BytesIO
from pathlib import Path
from typing import Any

__all__ = [
    "create_output_lines_filter",
    "create_output_lines_test",
    "create_output_regex_test",
    "create_output_test_from_file",
    "get_default_filtered_patterns",
    "get_default_filtered_prefixes",
    "get_rmw_output_filter",
]

OutputTest = tuple[
    BytesIO,
    Callable[[BytesIO, bytes], Any],
    Callable[[BytesIO, Any], bool],
    list[Any],
]
"""Output so far, function that adds to it, function that matches, what is expected."""


def get_default_filtered_prefixes() -> list[bytes]:
    return [b"pid", b"rc"]


def get_default_filtered_patterns() -> list[bytes]:
    return []


def get_rmw_output_filter(rmw_implementation: str, filter_type: str) -> list[bytes]:
    """Return the lines that a middleware prints: none here.

    Raises:
        TypeError: the type is not ``prefixes`` or ``patterns``.
    """
    if filter_type not in ("prefixes", "patterns"):
        raise TypeError(f"filter_type {filter_type!r}: expected prefixes or patterns")
    return []


def create_output_lines_filter(
    filtered_prefixes: Iterable[bytes] | None = None,
    filtered_patterns: Iterable[Any] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[bytes], bytes]:
    """Return a function that removes lines by their start or by a pattern.

    Args:
        filtered_prefixes: default: ``pid`` and ``rc``.
    """
    prefixes = tuple(filtered_prefixes or get_default_filtered_prefixes())
    patterns = [re.compile(each) for each in filtered_patterns or ()]

    def remove(output: bytes) -> bytes:
        return b"".join(
            line
            for line in output.splitlines(keepends=True)
            if not line.startswith(prefixes)
            and not any(pattern.match(line) for pattern in patterns)
        )

    return remove


def create_output_lines_test(expected_lines: Iterable[bytes]) -> OutputTest:
    """Return a test: each text is part of some line."""

    def contains(output: BytesIO, line: bytes) -> bool:
        return any(line in written for written in output.getvalue().splitlines())

    return BytesIO(), BytesIO.write, contains, list(expected_lines)


def create_output_regex_test(expected_patterns: Iterable[Any]) -> OutputTest:
    """Return a test: each compiled pattern is found in the whole output."""

    def contains(output: BytesIO, pattern: Any) -> bool:
        return pattern.search(output.getvalue()) is not None

    return BytesIO(), BytesIO.write, contains, list(expected_patterns)


def create_output_test_from_file(output_file: str) -> OutputTest:
    """Return a test of the lines of ``FILE.txt`` or of the patterns of ``FILE.regex``.

    Raises:
        RuntimeError: neither of the files exists.
    """
    texts, patterns = Path(f"{output_file}.txt"), Path(f"{output_file}.regex")
    if texts.is_file():
        return create_output_lines_test(texts.read_bytes().splitlines())
    if patterns.is_file():
        lines = patterns.read_bytes().splitlines()
        return create_output_regex_test(map(re.compile, lines))
    raise RuntimeError(f"could not find {texts} or {patterns}")
