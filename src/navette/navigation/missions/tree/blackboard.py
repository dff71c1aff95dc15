"""Blackboard of a behaviour tree: named entries that its nodes share."""

from collections.abc import Iterator, Mapping
from typing import Any


class TreeBlackboard:
    """Entries by name; that of a subtree shares chosen entries with its parent's.

    Args:
        parent: blackboard of the tree that contains this subtree.
        remapped: own name → name in the parent.
        shares_all: whether every other name is the parent's too (``_autoremap``);
            names that begin with ``_`` stay private.
    """

    def __init__(
        self,
        parent: "TreeBlackboard | None" = None,
        remapped: Mapping[str, str] | None = None,
        *,
        shares_all: bool = False,
    ) -> None:
        self._parent = parent
        self._remapped = dict(remapped or {})
        self._shares_all = shares_all
        self._entries: dict[str, Any] = {}

    def get(self, name: str, default: Any = None) -> Any:
        """Return an entry; ``@name`` is that of the root blackboard."""
        board, own = self._owner(name)
        return board._entries.get(own, default)

    def set(self, name: str, value: Any) -> None:
        board, own = self._owner(name)
        board._entries[own] = value

    def unset(self, name: str) -> None:
        """Remove an entry, if it exists."""
        board, own = self._owner(name)
        board._entries.pop(own, None)

    def __contains__(self, name: str) -> bool:
        board, own = self._owner(name)
        return own in board._entries

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def _owner(self, name: str) -> "tuple[TreeBlackboard, str]":
        """Return the blackboard that stores a name, and the name there."""
        if name.startswith("@"):
            board = self
            while board._parent is not None:
                board = board._parent
            return board, name[1:]
        if self._parent is not None:
            if name in self._remapped:
                return self._parent._owner(self._remapped[name])
            if self._shares_all and not name.startswith("_"):
                return self._parent._owner(name)
        return self, name
