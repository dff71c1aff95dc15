"""ServiceEntry under ``nodes:`` as written in ``navette.yaml``."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from navette.errors import InvalidValueError, NavetteError

_KINDS = ("run", "launch", "command")
_RUN_KEYS = ("parameters", "parameter_files", "remap", "namespace", "node_name")
_KEYS = (
    *_KINDS,
    "name",
    "node_name",
    "namespace",
    "arguments",
    "parameters",
    "parameter_files",
    "remap",
    "environment",
    "restart",
    "stop_timeout_s",
    "processes",
    "shell",
)


class EntryError(InvalidValueError):
    """Invalid value of ``key`` in an entry or in its service."""

    def __init__(self, key: str, reason: str) -> None:
        super().__init__(reason)
        self.key = key


@contextmanager
def errors_under(key: str) -> Iterator[None]:
    """Attribute errors raised in the block to the value of ``key``."""
    try:
        yield
    except EntryError:
        raise
    except NavetteError as error:
        raise EntryError(key, str(error)) from error


@dataclass(frozen=True)
class ServiceEntry:
    """Settings of one process, on the three levels of the file.

    Attributes:
        service: name of the service.
        own: the entry itself.
        shared: the service.
        everywhere: the top of the file.
    """

    service: str
    own: Mapping[str, Any]
    shared: Mapping[str, Any]
    everywhere: Mapping[str, Any]

    @classmethod
    def of(
        cls,
        service: str,
        entry: Any,
        shared: Mapping[str, Any],
        everywhere: Mapping[str, Any],
    ) -> "ServiceEntry":
        """Check an entry; a string is the command line of ``navette run``.

        Raises:
            InvalidValueError: neither a string nor a mapping, an unknown key, or not
                exactly one of run, launch and command.
        """
        own = {"run": entry} if isinstance(entry, str) else entry
        if not isinstance(own, dict):
            raise InvalidValueError(
                f"{entry!r}: expected the arguments of 'navette run', or a mapping"
            )
        for key in own:
            if key not in _KEYS:
                known = ", ".join(_KEYS)
                raise EntryError(key, f"unknown key {key!r} (known: {known})")
        kinds = [kind for kind in _KINDS if kind in own]
        if len(kinds) != 1:
            found = " and ".join(kinds) or "none"
            raise InvalidValueError(
                f"expected exactly one of {', '.join(_KINDS)}; found {found}"
            )
        for key in _RUN_KEYS if kinds != ["run"] else ():
            if key in own:
                reason = f"{key} is valid with 'run' only, not with {kinds[0]!r}"
                raise EntryError(key, reason)
        return cls(service, own, shared, everywhere)

    @property
    def kind(self) -> str:
        """``run``, ``launch`` or ``command``."""
        return next(kind for kind in _KINDS if kind in self.own)

    def get(self, key: str) -> Any:
        """Return the entry's own value, else the service's."""
        return self.own.get(key, self.shared.get(key))

    def all_of(self, key: str) -> list[Any]:
        """Return the values of all levels; later ones override earlier ones."""
        levels = (self.everywhere, self.shared, self.own)
        return [each[key] for each in levels if each.get(key)]
