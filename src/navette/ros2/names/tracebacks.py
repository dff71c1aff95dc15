"""A program's traceback without the frames in between that are Navette's."""

import os
from collections.abc import Iterator
from pathlib import Path
from traceback import StackSummary, TracebackException
from types import TracebackType

from navette.errors import NavetteError

_PACKAGE = str(Path(__file__).parents[2]) + os.sep


def shortened(error: BaseException, start: TracebackType | None) -> TracebackException:
    """What to print of an exception and of those that led to it.

    Of a callback that raises, three frames of four are the executor's. They are left
    out where the program itself, or a check of Navette's, raised; what went wrong
    inside Navette is shown whole.

    Args:
        start: its first frame to show.
    """
    shown = TracebackException(type(error), error, start)
    for each, original in _chain(shown, error):
        frames = [f for f in each.stack if not f.filename.startswith(_PACKAGE)]
        is_own = bool(each.stack) and each.stack[-1] not in frames
        if frames and (isinstance(original, NavetteError) or not is_own):
            each.stack = StackSummary.from_list(frames)
    return shown


def _chain(
    shown: TracebackException, error: BaseException
) -> Iterator[tuple[TracebackException, BaseException]]:
    """An exception, what caused it, and what was handled when it came."""
    yield shown, error
    for name in ("__cause__", "__context__"):
        before, original = getattr(shown, name), getattr(error, name)
        if before is not None and original is not None:
            yield from _chain(before, original)
