"""Guard conditions and waitables of :class:`Node`, as rclpy has them."""

from collections.abc import Callable, Iterator
from typing import Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.context import Context
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.wait_set import WaitableEvents
from navette.runtime.waitable import Waitable


class NodeWaitables:
    """What a node waits for besides messages, requests and time. Mixed in."""

    _context: Context
    _entities: list[Any]

    def get_fully_qualified_name(self) -> str:
        raise NotImplementedError

    def _own_group(self, group: CallbackGroup | None) -> CallbackGroup:
        raise NotImplementedError

    def _forget(self, entity: Any) -> None:
        raise NotImplementedError

    def _destroy(self, entity: Any) -> bool:
        raise NotImplementedError

    @property
    def guards(self) -> Iterator[GuardCondition]:
        return (e for e in self._entities if isinstance(e, GuardCondition))

    @property
    def waitables(self) -> Iterator[Waitable[Any]]:
        return (e for e in self._entities if isinstance(e, Waitable))

    def create_guard_condition(
        self,
        callback: Callable[[], Any] | None,
        callback_group: CallbackGroup | None = None,
    ) -> GuardCondition:
        """Call ``callback`` after its ``trigger()``."""
        guard = GuardCondition(
            callback,
            self._own_group(callback_group),
            self._context,
            node_name=self.get_fully_qualified_name(),
            on_destroy=self._forget,
        )
        guard.group.add_entity(guard)
        self._entities.append(guard)
        return guard

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        return self._destroy(guard)

    def add_waitable(self, waitable: Waitable[Any]) -> None:
        """Run it when it is ready; keep it, and destroy it with the node."""
        self._entities.append(waitable)
        if type(waitable).add_to_wait_set is Waitable.add_to_wait_set:
            return  # one of ours, which the loop runs by its parts
        events = WaitableEvents(
            waitable,
            self._own_group(waitable.callback_group),
            self._context.loop,
            self.get_fully_qualified_name(),
        )
        waitable.add_to_wait_set(events.wait_set)

    def remove_waitable(self, waitable: Waitable[Any]) -> None:
        self._forget(waitable)
