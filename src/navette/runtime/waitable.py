"""Waitables: composite entities of a node, such as actions or a program's own."""

from typing import Any, Generic, TypeVar

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.events import Entity
from navette.runtime.future import Future
from navette.runtime.loop import EventLoop
from navette.runtime.wait_set import NumberOfEntities, WaitSet

T = TypeVar("T")


class Waitable(Generic[T]):
    """Base class of the objects that :meth:`Node.add_waitable` takes.

    A program's own waitable adds guard conditions and timers (without callbacks of
    their own) in :meth:`add_to_wait_set`. When one of them is due and
    :meth:`is_ready` returns true, the result of :meth:`take_data` is passed to
    :meth:`execute`. Navette's actions consist of services, topics and calls, which the
    loop runs directly, and do not use these methods.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        callback_group.add_entity(self)
        self._futures: list[Future[Any]] = []

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Add entities to the wait set and store their indices."""
        raise NotImplementedError("must be implemented by subclass")

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Return whether :meth:`execute` has to run."""
        raise NotImplementedError("must be implemented by subclass")

    def take_data(self) -> T:
        """Return the argument for :meth:`execute`."""
        raise NotImplementedError("must be implemented by subclass")

    async def execute(self, taken_data: T) -> None:
        """Process the data."""
        raise NotImplementedError("must be implemented by subclass")

    def get_num_entities(self) -> NumberOfEntities:
        """Return how many entities of each kind it waits for; unused by Navette."""
        raise NotImplementedError("must be implemented by subclass")

    def add_future(self, future: Future[Any]) -> None:
        """Record a pending future; its callbacks run without this."""
        self._futures.append(future)

    def remove_future(self, future: Future[Any]) -> None:
        self._futures.remove(future)

    def destroy(self) -> None:
        """Destroy the entities that the waitable consists of."""

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


class WaitableEvents(Entity):
    """Runs a program's own waitable when an entity of its wait set is due."""

    __slots__ = ("_is_queued", "_loop", "_node_name", "_waitable", "wait_set")

    def __init__(
        self,
        waitable: Waitable[Any],
        group: CallbackGroup,
        loop: EventLoop,
        node_name: str,
    ) -> None:
        self.group = group
        self._waitable = waitable
        self._loop = loop
        self._node_name = node_name
        self._is_queued = False
        self.wait_set = WaitSet(on_due=self._queue)

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
