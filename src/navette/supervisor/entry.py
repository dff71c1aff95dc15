"""An entry under ``nodes:``, as it stands in the file."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from navette.errors import InvalidValueError, NavetteError

_KINDS = ("run", "launch", "command")
_ONLY_RUN = ("parameters", "parameter_files", "remap", "namespace", "node_name")
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
    """What an entry, or its module, says under a key is wrong."""

    def __init__(self, key: str, reason: str) -> None:
        super().__init__(reason)
        self.key = key


@contextmanager
def under(key: str) -> Iterator[None]:
    """What goes wrong meanwhile is the fault of what is said under a key."""
    try:
        yield
    except EntryError:
        raise
    except NavetteError as error:
        raise EntryError(key, str(error)) from error


@dataclass(frozen=True)
class Entry:
    """What the file says of a process.

    ``own``: in its entry; ``shared``: in its module, for all of them; ``everywhere``:
    at the top of the file, for all modules.
    """

    module: str
    own: Mapping[str, Any]
    shared: Mapping[str, Any]
    everywhere: Mapping[str, Any]

    @classmethod
    def of(
        cls,
        module: str,
        entry: Any,
        shared: Mapping[str, Any],
        everywhere: Mapping[str, Any],
    ) -> "Entry":
        """A text is what stands behind ``navette run``.

        Raises:
            InvalidValueError: neither text nor mapping, an unknown key, or not exactly
                one of run, launch and command.
        """
        own = {"run": entry} if isinstance(entry, str) else entry
        if not isinstance(own, dict):
            raise InvalidValueError(
                f"{entry!r}: wanted what follows 'navette run', or a mapping"
            )
        for key in own:
            if key not in _KEYS:
                raise EntryError(
                    key, f"unknown key {key!r} (known: {', '.join(_KEYS)})"
                )
        kinds = [kind for kind in _KINDS if kind in own]
        if len(kinds) != 1:
            raise InvalidValueError(
                f"an entry has {' and '.join(kinds) or 'nothing to start'}; "
                f"wanted one of {', '.join(_KINDS)}"
            )
        for key in _ONLY_RUN if kinds != ["run"] else ():
            if key in own:
                raise EntryError(key, f"{key} goes with 'run', not with {kinds[0]!r}")
        return cls(module, own, shared, everywhere)

    @property
    def kind(self) -> str:
        return next(kind for kind in _KINDS if kind in self.own)

    def get(self, key: str) -> Any:
        """The entry's own value, or the module's."""
        return self.own.get(key, self.shared.get(key))

    def all_of(self, key: str) -> list[Any]:
        """What the file, the module and the entry say; the last wins."""
        levels = (self.everywhere, self.shared, self.own)
        return [each[key] for each in levels if each.get(key)]
