"""Characters that act on a terminal instead of being shown, in what others sent."""

import re

# They move the cursor, colour, ring, or turn the order of letters round; a line's end
# and a tab are shown.
_ACTING = "\x7f-\x9f\u2028-\u202e\u2066-\u2069"
_CONTROL = re.compile(f"[\x00-\x08\x0b-\x1f{_ACTING}]")
_CONTROL_IN_JSON = re.compile(f"[{_ACTING}]")


def escaped(text: str) -> str:
    r"""As ``\x1b`` and ``\u202e`` what would act."""
    return _CONTROL.sub(_escape, text)


def escaped_json(text: str) -> str:
    """The same JSON, with what would act escaped (JSON itself does the others)."""
    return _CONTROL_IN_JSON.sub(lambda match: f"\\u{ord(match[0]):04x}", text)


def _escape(match: re.Match[str]) -> str:
    number = ord(match[0])
    return f"\\x{number:02x}" if number < 0x100 else f"\\u{number:04x}"
