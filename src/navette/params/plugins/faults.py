"""Calls of a user's method: exceptions and wrong results become one kind of error."""

import traceback
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import NavetteError

_PACKAGE = Path(__file__).parents[2]
_LONGEST_REPR = 200


class MethodFaultError(NavetteError):
    """A user's method raised, or returned something else than its protocol requires."""


def own_call(name: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a user's method.

    Raises:
        MethodFaultError: the method raised; the text has the traceback's lines from the
            method on, without those of the caller.
    """
    try:
        return function(*arguments)
    except Exception as error:  # a user's method may raise anything
        lines = "".join(traceback.format_list(_own_frames(error.__traceback__)))
        raise MethodFaultError(
            f"{name} raised {type(error).__name__}: {error}\n{lines}".rstrip()
        ) from error


def checked_array(
    name: str, value: Any, expected: str, fits: Callable[[tuple[int, ...]], bool]
) -> NDArray[np.float64]:
    """Return the result of a user's method as an array of finite numbers.

    Args:
        name: name of the method, for the error.
        value: what it returned.
        expected: the expected shape in words.
        fits: whether a shape is expected.

    Raises:
        MethodFaultError: not numbers, of another shape, NaN or infinite.
    """
    if value is None:
        raise MethodFaultError(f"{name} returned None; expected {expected}")
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        shown = repr(value)[:_LONGEST_REPR]
        raise MethodFaultError(
            f"{name} returned {type(value).__name__} {shown}; expected {expected}"
        ) from None
    if not fits(array.shape):
        found = f"an array of shape {array.shape}" if array.ndim else f"{array:g} alone"
        raise MethodFaultError(f"{name} returned {found}; expected {expected}")
    finite = np.isfinite(array)
    if not finite.all():
        at = tuple(int(i) for i in np.argwhere(~finite)[0])
        where = f" at index {at[0] if len(at) == 1 else at}" if at else ""
        raise MethodFaultError(
            f"{name} returned {array[at]}{where}; expected {expected}, all finite"
        )
    return array


def _own_frames(
    trace: TracebackType | None,
) -> traceback.StackSummary:
    """Return the frames from the first one outside Navette on."""
    frames = traceback.extract_tb(trace)
    for first, frame in enumerate(frames):
        if not Path(frame.filename).is_relative_to(_PACKAGE):
            return traceback.StackSummary.from_list(frames[first:])
    return frames
