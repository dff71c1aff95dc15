"""What a program's own waitable waits for, under the names of rclpy's wait set."""

from functools import partial
from typing import TYPE_CHECKING, Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.events import Entity
from navette.runtime.handles import Handle
from navette.runtime.loop import EventLoop

if TYPE_CHECKING:
    from navette.runtime.waitable import Waitable


class NumberOfEntities:
    """How many things of each kind are waited for."""

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


class WaitSet:
    """Notes which of the things in it are due.

    Each is handed over with its callback: it is this set's from then on.
    """

    def __init__(self, wake: Any) -> None:
        self._wake = wake
        self._counts: dict[str, int] = {}
        self._ready: set[tuple[str, int]] = set()

    def add_guard_condition(self, guard: Any) -> int:
        """Wait for its trigger; gives its index."""
        return self._add("guard_condition", guard)

    def add_timer(self, timer: Any) -> int:
        """Wait until it is due; gives its index."""
        return self._add("timer", timer)

    def is_ready(self, entity_type: str, index: int | None) -> bool:
        """Whether that one is due (``"guard_condition"`` or ``"timer"``)."""
        return (entity_type, index) in self._ready

    def get_ready_entities(self, entity_type: str) -> list[int]:
        """The indices of those that are due."""
        return sorted(index for kind, index in self._ready if kind == entity_type)

    def clear(self) -> None:
        """Nothing is due any more."""
        self._ready.clear()

    def _add(self, kind: str, entity: Any) -> int:
        index = self._counts.get(kind, 0)
        self._counts[kind] = index + 1
        if isinstance(entity, Handle):
            entity = entity.entity
        entity.callback = partial(self._note, kind, index)
        return index

    def _note(self, kind: str, index: int) -> None:
        self._ready.add((kind, index))
        self._wake()


class WaitableEvents(Entity):
    """Runs a program's own waitable when what it waits for is due."""

    __slots__ = ("_is_queued", "_loop", "_node_name", "_waitable", "wait_set")

    def __init__(
        self,
        waitable: "Waitable[Any]",
        group: CallbackGroup,
        loop: EventLoop,
        node_name: str,
    ) -> None:
        self.group = group
        self._waitable = waitable
        self._loop = loop
        self._node_name = node_name
        self._is_queued = False
        self.wait_set = WaitSet(self._queue)

    def run(self) -> Any:
        self._is_queued = False
        if not self._waitable.is_ready(self.wait_set):
            return None
        self.wait_set.clear()
        return self._waitable.execute(self._waitable.take_data())

    def origin(self) -> tuple[str, str]:
        return self._node_name, f"waitable {type(self._waitable).__name__}"

    def _queue(self) -> None:
        if not self._is_queued:
            self._is_queued = True
            self._loop.ready.append(self)
