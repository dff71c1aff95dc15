"""Checks of the types of arguments."""

import inspect
from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError


def isclassinstance(value: object) -> bool:
    """Whether a value is an instance of a class; every value is."""
    return hasattr(value, "__class__")


def is_a(value: object, kind: type) -> bool:
    """Whether a value is an instance of a class or of its subclasses."""
    return isinstance(value, kind)


def is_a_subclass(value: Any, kind: type) -> bool:
    """Whether a class, or the class of an instance, is or derives from ``kind``."""
    return issubclass(value if inspect.isclass(value) else type(value), kind)


def ensure_argument_type(
    argument: object,
    types: type | Iterable[type] | None,
    argument_name: str,
    caller: str | None = None,
) -> None:
    """Check the type of an argument.

    Raises:
        InvalidLaunchValueError: it is of none of the types; names argument and caller.
    """
    kinds = tuple(types) if isinstance(types, Iterable) else (types,)
    if not all(inspect.isclass(kind) for kind in kinds):
        raise InvalidLaunchValueError(f"types {types!r}: expected a class or a list")
    if not isinstance(argument, kinds):  # type: ignore[arg-type] # checked above
        expected = ", ".join(kind.__name__ for kind in kinds if kind is not None)
        of = f" of {caller}" if caller else ""
        raise InvalidLaunchValueError(
            f"argument {argument_name!r}{of}: {argument!r} "
            f"({type(argument).__name__}); expected {expected}"
        )
