"""Whether colours are wanted."""

import os


def colours_wanted() -> bool:
    """Whether to print colours to a terminal: no ``NO_COLOR``, no dumb terminal."""
    return "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"
