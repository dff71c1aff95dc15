# SPDX-License-Identifier: Apache-2.0
"""Lines that fit a terminal: wrapped between words, not within them."""

import textwrap


def filled(line: str, columns: int, indent: int = 2) -> str:
    """Wrap a line at spaces; long words are not broken.

    Args:
        columns: width of the terminal.
        indent: columns before the second and further lines.
    """
    if len(line) <= columns:
        return line
    return textwrap.fill(
        line,
        columns,
        subsequent_indent=" " * indent,
        break_long_words=False,
        break_on_hyphens=False,
        replace_whitespace=False,
    )
