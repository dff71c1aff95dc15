"""The methods of one stage by name: Navette's, of installed packages, and of files."""

from collections.abc import Callable, Collection, Iterator
from functools import lru_cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, TypeVar

from navette.errors import InvalidValueError, UnknownNameError
from navette.params.plugins.loading import (
    Method,
    Protocols,
    checked_method,
    load_method,
)

C = TypeVar("C", bound=Callable[..., Any])


class MethodRegistry(Collection[str]):
    """Methods of a stage: name → class with a dataclass of parameters, or function.

    A name is that of a method that is registered here, that of an entry point of an
    installed package, or the place of the user's own: ``FILE.py:NAME``, ``MODULE:NAME``
    or ``FILE.py``. As a collection it has the registered names; it contains every name
    that can be loaded.

    Args:
        kind: what it is, for errors.
        group: the group of entry points.
        protocols: name of a method → names of its arguments; a method has one of them.
    """

    def __init__(self, kind: str, group: str, protocols: Protocols) -> None:
        self.kind = kind
        self.group = group
        self.protocols = protocols
        self._targets: dict[str, Callable[..., Any]] = {}

    def register(self, name: str) -> Callable[[C], C]:
        """Return a decorator that registers a class or function.

        Raises:
            InvalidValueError: the name is taken, or the target lacks the protocol.
        """

        def add(target: C) -> C:
            if name in self._targets:
                raise InvalidValueError(f"{self.kind} {name!r} is registered already")
            checked_method(name, target, self.protocols, self.kind)
            self._targets[name] = target
            return target

        return add

    def __iter__(self) -> Iterator[str]:
        return iter(self._targets)

    def __len__(self) -> int:
        return len(self._targets)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and (
            name in self._targets or is_place(name) or name in self.installed()
        )

    def installed(self) -> dict[str, EntryPoint]:
        """Return the entry points of installed packages by name."""
        return _installed(self.group)

    def is_named(self, name: str) -> bool:
        """Whether it is a name, not the place of a file or module."""
        return name in self._targets or name in self.installed()

    def load(self, name: str) -> Method:
        """Return the method.

        Raises:
            UnknownNameError: unknown name, file or module; lists the known ones.
            InvalidValueError: it cannot be imported, or lacks the protocol.
        """
        target = self._targets.get(name)
        if target is not None:
            method = checked_method(name, target, self.protocols, self.kind)
            return Method(name, target, method.entry, is_own=_is_own(target))
        if is_place(name):
            return load_method(name, self.protocols, self.kind)
        point = self.installed().get(name)
        if point is None:
            known = [*self._targets, *self.installed()]
            error = UnknownNameError.of(self.kind, name, known)
            raise UnknownNameError(f"{error}; your own: FILE.py:NAME or MODULE:NAME")
        method = load_method(point.value, self.protocols, self.kind)
        return Method(name, method.target, method.entry, is_own=True)


def is_place(name: str) -> bool:
    """Whether the name is the place of a file or module."""
    return ":" in name or name.endswith(".py")


@lru_cache
def _installed(group: str) -> dict[str, EntryPoint]:
    return {point.name: point for point in entry_points(group=group)}


def _is_own(target: Callable[..., Any]) -> bool:
    return not target.__module__.startswith("navette.")
