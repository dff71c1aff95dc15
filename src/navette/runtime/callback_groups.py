"""Callback groups: which callbacks may start while another one is in progress.

On the deterministic loop a callback runs to its end unless it waits (a nested spin, a
coroutine's ``await``). While a callback waits, its group decides: a mutually exclusive
group holds its other callbacks, a reentrant group lets them start. A callback that
waits for a service or an action lets the group's servers run (decision 0021). The
groups of a MultiThreadedExecutor's nodes run their callbacks in its threads.
"""

from collections import deque
from collections.abc import Callable
from typing import Any, Protocol


class Threads(Protocol):
    """Threads that run the callbacks of groups."""

    @property
    def free_group(self) -> "ReentrantCallbackGroup":
        """Group of the tasks without a group of their own."""

    def start(self, entity: Any, rules: "CallbackGroup | None") -> None:
        """Run an event whose group lets it start, by its own ``rules`` if any."""

    def post(self, function: Callable[[], Any]) -> None:
        """Run a function in the loop, between two events."""


class CallbackGroup:
    """Base class of callback groups; programs may define their own.

    Events are parked while ``held`` is above zero. A subclass that overrides
    :meth:`can_execute` or :meth:`beginning_execution` has its own rules: its groups
    stay held (``floor``), and the loop calls the rules before each event. Groups with
    threads stay held too, so that other groups' events pay nothing for either.
    """

    #: Whether a waiting callback keeps the group's other callbacks from starting.
    exclusive = False
    #: Whether a subclass has its own rules.
    has_rules = False

    __slots__ = (
        "__weakref__",
        "_entities",
        "calling",
        "floor",
        "held",
        "parked",
        "ready",
        "threads",
    )

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls.has_rules = any(
            getattr(cls, name) is not getattr(CallbackGroup, name)
            for name in ("can_execute", "beginning_execution", "ending_execution")
        )

    def __init__(self) -> None:
        self.held = self.floor = 1 if self.has_rules else 0
        #: Number of the holds that are callbacks waiting for a service.
        self.calling = 0
        self.parked: deque[Any] = deque()
        #: The loop's queue; set when a node takes the group.
        self.ready: deque[Any] | None = None
        #: Threads that run the callbacks; None: the thread that spins.
        self.threads: Threads | None = None
        self._entities: dict[Any, None] = {}

    def add_entity(self, entity: Any) -> None:
        """Add an entity whose callback belongs to this group."""
        self._entities[entity] = None

    def remove_entity(self, entity: Any) -> None:
        """Remove a destroyed entity."""
        self._entities.pop(entity, None)

    def has_entity(self, entity: Any) -> bool:
        return entity in self._entities

    def can_execute(self, entity: Any) -> bool:
        """Return whether the entity's callback may start now."""
        return self.held == self.floor

    def beginning_execution(self, entity: Any) -> bool:
        """Return whether to start the callback; called right before it."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Called when the callback has ended."""

    def blocks(self, entity: Any) -> bool:
        """Return whether an event must wait; called while the group is held."""
        return self.held > self.floor or (
            self.has_rules and not self.can_execute(entity)
        )

    def retry_parked(self) -> None:
        """Queue the parked events if the rules let the first of them start now."""
        if self.parked and self.ready is not None and not self.blocks(self.parked[0]):
            self.ready.extendleft(reversed(self.parked))
            self.parked.clear()

    def run_in(self, threads: Threads | None) -> None:
        """Run the callbacks in these threads; None: in the thread that spins."""
        step = (threads is not None) - (self.threads is not None)
        self.threads = threads
        self.floor += step
        self.held += step

    def hold(self) -> None:
        """Park the group's events until the matching :meth:`release`."""
        self.held += 1

    def begin_call(self) -> None:
        """Let servers run despite the hold until :meth:`end_call`."""
        if self.threads is None:
            self._begin_call()
        else:
            self.threads.post(self._begin_call)

    def end_call(self) -> None:
        """Undo one :meth:`begin_call`."""
        if self.threads is None:
            self._end_call()
        else:
            self.threads.post(self._end_call)

    def _begin_call(self) -> None:
        self.calling += 1
        servers = [entity for entity in self.parked if entity.runs_during_calls]
        if servers and self.ready is not None:
            self.ready.extendleft(reversed(servers))
            self.parked = deque(e for e in self.parked if not e.runs_during_calls)

    def _end_call(self) -> None:
        self.calling -= 1

    def release(self) -> None:
        """Undo one :meth:`hold`; parked events run first, in their old order."""
        self.held -= 1
        if self.held > self.floor or not self.parked or self.ready is None:
            return
        if self.exclusive and self.threads is not None:
            # It holds the group until its thread has run it; then the next one follows.
            self.ready.appendleft(self.parked.popleft())
            return
        self.ready.extendleft(reversed(self.parked))
        self.parked.clear()


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """At most one of the group's callbacks is in progress at a time."""

    exclusive = True
    __slots__ = ()


class ReentrantCallbackGroup(CallbackGroup):
    """Any of the group's callbacks may start while others wait."""

    __slots__ = ()
