"""Tracebacks of programs without Navette's frames."""

import os
from collections.abc import Iterator
from pathlib import Path
from traceback import StackSummary, TracebackException
from types import TracebackType

from navette.errors import NavetteError

_PACKAGE = str(Path(__file__).parents[2]) + os.sep


def shortened(error: BaseException, start: TracebackType | None) -> TracebackException:
    """Return the traceback of an exception and of its causes, ready to print.

    Most frames of an exception in a callback belong to the executor. They are removed
    if the program or one of Navette's checks raised the exception; the traceback of an
    internal error stays complete.

    Args:
        start: the first frame to show.
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
    """Yield an exception, its cause, and the exception handled when it was raised."""
    yield shown, error
    for name in ("__cause__", "__context__"):
        before, original = getattr(shown, name), getattr(error, name)
        if before is not None and original is not None:
            yield from _chain(before, original)
