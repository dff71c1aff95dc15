"""Wait sets of a program's own waitables, under rclpy's names."""

from collections.abc import Callable
from functools import partial
from typing import Any

from navette.runtime.handles import Handle


class NumberOfEntities:
    """Number of entities of each kind that a waitable waits for."""

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions = num_subs
        self.num_guard_conditions = num_gcs
        self.num_timers = num_timers
        self.num_clients = num_clients
        self.num_services = num_services
        self.num_events = num_events

    def __add__(self, other: "NumberOfEntities") -> "NumberOfEntities":
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return type(self)(*(mine + others for mine, others in pairs))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, NumberOfEntities):
            return NotImplemented
        return vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<NumberOfEntities({', '.join(map(str, vars(self).values()))})>"


OnDue = Callable[[], object]
"""Called when an entity becomes due."""


class WaitSet:
    """Records which of its guard conditions and timers are due.

    The set replaces the callback of each entity that is added to it.
    """

    def __init__(self, *, on_due: OnDue) -> None:
        self._on_due = on_due
        self._counts: dict[str, int] = {}
        self._ready: set[tuple[str, int]] = set()

    def add_guard_condition(self, guard: Any) -> int:
        """Add a guard condition, due when triggered; return its index."""
        return self._add("guard_condition", guard)

    def add_timer(self, timer: Any) -> int:
        """Add a timer; return its index."""
        return self._add("timer", timer)

    def is_ready(self, entity_type: str, index: int | None) -> bool:
        """Return whether a ``"guard_condition"`` or ``"timer"`` is due."""
        return (entity_type, index) in self._ready

    def get_ready_entities(self, entity_type: str) -> list[int]:
        """Return the indices of the due entities of that type."""
        return sorted(index for kind, index in self._ready if kind == entity_type)

    def clear(self) -> None:
        """Mark all entities as not due."""
        self._ready.clear()

    def _add(self, kind: str, entity: Any) -> int:
        index = self._counts.get(kind, 0)
        self._counts[kind] = index + 1
        if isinstance(entity, Handle):
            entity = entity.entity
        entity.callback = partial(self._mark_due, kind, index)
        return index

    def _mark_due(self, kind: str, index: int) -> None:
        self._ready.add((kind, index))
        self._on_due()
