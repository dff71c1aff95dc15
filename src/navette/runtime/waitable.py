"""What a node has besides topics, services and timers: actions, or a program's own."""

from typing import Any, Generic, TypeVar

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.future import Future
from navette.runtime.wait_set import NumberOfEntities, WaitSet

T = TypeVar("T")


class Waitable(Generic[T]):
    """Base of the things that :meth:`Node.add_waitable` takes.

    A program's own says in :meth:`add_to_wait_set` what it waits for (guard conditions
    and timers without callbacks of their own). When one of them is due and
    :meth:`is_ready` agrees, :meth:`execute` gets what :meth:`take_data` took.
    Navette's own are put together from services, topics and calls instead, which the
    loop runs anyway.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        callback_group.add_entity(self)
        self._futures: list[Future[Any]] = []

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Add what is waited for, and keep the indices."""
        raise NotImplementedError("must be implemented by subclass")

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Whether what was waited for is there."""
        raise NotImplementedError("must be implemented by subclass")

    def take_data(self) -> T:
        """What :meth:`execute` is given."""
        raise NotImplementedError("must be implemented by subclass")

    async def execute(self, taken_data: T) -> None:
        """Do the work."""
        raise NotImplementedError("must be implemented by subclass")

    def get_num_entities(self) -> NumberOfEntities:
        """How many things of each kind it waits for; asked by nobody here."""
        raise NotImplementedError("must be implemented by subclass")

    def add_future(self, future: Future[Any]) -> None:
        """Note a future under way; its callbacks run without that."""
        self._futures.append(future)

    def remove_future(self, future: Future[Any]) -> None:
        """Forget it."""
        self._futures.remove(future)

    def destroy(self) -> None:
        """Take down what it is put together from."""

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()
