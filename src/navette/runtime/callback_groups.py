"""Callback groups: which callbacks may start while another has not ended.

On the one deterministic loop a callback runs to its end unless it waits (a nested
spin, a coroutine's ``await``). While it waits, its own group decides: mutually
exclusive ones hold their other callbacks back, re-entrant ones let them start. Who
waits for a service or an action lets the group's servers answer (decision 0021).
"""

from collections import deque
from typing import Any


class CallbackGroup:
    """Base of the two kinds, and of a program's own.

    Events are held back while ``held`` is above zero. A class that overrides
    :meth:`can_execute` or :meth:`beginning_execution` has rules of its own: its groups
    are held for ever (``floor``), and asked before each event.
    """

    #: Whether a waiting callback keeps the others of the group from starting.
    exclusive = False
    #: Whether a subclass decides by itself.
    has_rules = False

    __slots__ = (
        "__weakref__",
        "_entities",
        "calling",
        "floor",
        "held",
        "parked",
        "ready",
    )

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls.has_rules = any(
            getattr(cls, name) is not getattr(CallbackGroup, name)
            for name in ("can_execute", "beginning_execution", "ending_execution")
        )

    def __init__(self) -> None:
        self.held = self.floor = 1 if self.has_rules else 0
        self.calling = 0  # how many of the holds are callbacks that wait for a service
        self.parked: deque[Any] = deque()
        self.ready: deque[Any] | None = None  # the loop's queue, once known
        self._entities: list[Any] = []

    def add_entity(self, entity: Any) -> None:
        """Note that ``entity``'s callback belongs to this group."""
        self._entities.append(entity)

    def remove_entity(self, entity: Any) -> None:
        """Forget ``entity`` (it was destroyed)."""
        if entity in self._entities:
            self._entities.remove(entity)

    def has_entity(self, entity: Any) -> bool:
        return entity in self._entities

    def can_execute(self, entity: Any) -> bool:
        """Whether ``entity``'s callback might start now."""
        return self.held == self.floor

    def beginning_execution(self, entity: Any) -> bool:
        """Asked right before the callback; False holds it back after all."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Told when the callback has ended."""

    def blocks(self, entity: Any) -> bool:
        """Whether an event must wait; asked while the group is held."""
        return self.held > self.floor or not (
            self.has_rules and self.can_execute(entity)
        )

    def ask_again(self) -> None:
        """Queue what the rules held back, if they now let the first of it start."""
        if self.parked and self.ready is not None and not self.blocks(self.parked[0]):
            self.ready.extendleft(reversed(self.parked))
            self.parked.clear()

    def hold(self) -> None:
        """Keep the group's events back until the matching :meth:`release`."""
        self.held += 1

    def begin_call(self) -> None:
        """Let servers run in spite of the hold until :meth:`end_call`."""
        self.calling += 1
        servers = [entity for entity in self.parked if entity.answers_calls]
        if servers and self.ready is not None:
            self.ready.extendleft(reversed(servers))
            self.parked = deque(e for e in self.parked if not e.answers_calls)

    def end_call(self) -> None:
        """Undo one :meth:`begin_call`."""
        self.calling -= 1

    def release(self) -> None:
        """Undo one :meth:`hold`; parked events go first, in their old order."""
        self.held -= 1
        if self.held == self.floor and self.parked and self.ready is not None:
            self.ready.extendleft(reversed(self.parked))
            self.parked.clear()


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """At most one of the group's callbacks is under way at a time."""

    exclusive = True
    __slots__ = ()


class ReentrantCallbackGroup(CallbackGroup):
    """Any of the group's callbacks may start while others wait."""

    __slots__ = ()
