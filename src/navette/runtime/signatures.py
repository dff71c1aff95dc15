"""Number of arguments of a callback."""

import inspect
from collections.abc import Callable
from typing import Any


def takes_arguments(callback: Callable[..., Any], count: int) -> bool:
    """Whether ``callback`` accepts ``count`` positional arguments and no fewer."""
    try:
        signature = inspect.signature(callback)
    except (TypeError, ValueError):  # builtins without a signature
        return False
    return not _binds(signature, count - 1) and _binds(signature, count)


def can_take(callback: Any, *counts: int) -> bool:
    """Whether ``callback`` is a function of one of these numbers of arguments."""
    if not callable(callback):
        return False
    try:
        signature = inspect.signature(callback)
    except (TypeError, ValueError):  # builtins without a signature
        return True
    return any(_binds(signature, count) for count in counts)


def _binds(signature: inspect.Signature, count: int) -> bool:
    try:
        signature.bind(*[object()] * count)
    except TypeError:
        return False
    return True
