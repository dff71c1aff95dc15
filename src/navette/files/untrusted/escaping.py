"""Escape control characters of received text, which would act on the terminal."""

import re

# Cursor movement, colours, bell and text direction; newline and tab are kept.
_ACTING = "\x7f-\x9f\u2028-\u202e\u2066-\u2069"
_CONTROL = re.compile(f"[\x00-\x08\x0b-\x1f{_ACTING}]")
_COLOUR_OR_CONTROL = re.compile(
    rf"(?P<colour>\x1b\[(?:[0-4]|[39][0-7]|39)?(?:;(?:[0-4]|[39][0-7]|39))*m)|{_CONTROL.pattern}"
)
_CONTROL_IN_JSON = re.compile(f"[{_ACTING}]")


def escaped(text: str) -> str:
    r"""Replace control characters by ``\x1b`` or ``\u202e``."""
    return _CONTROL.sub(_escape, text)


def escaped_but_coloured(text: str) -> str:
    """Escape as :func:`escaped` does, except for colours and bold, dim, underlined."""
    return _COLOUR_OR_CONTROL.sub(lambda m: m["colour"] or _escape(m), text)


def escaped_json(text: str) -> str:
    """Escape the control characters that JSON itself does not escape."""
    return _CONTROL_IN_JSON.sub(lambda match: f"\\u{ord(match[0]):04x}", text)


def _escape(match: re.Match[str]) -> str:
    number = ord(match[0])
    return f"\\x{number:02x}" if number < 0x100 else f"\\u{number:04x}"
