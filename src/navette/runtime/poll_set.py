"""rclpy's internal ``WaitSet``: poll subscriptions and guard conditions by handle.

Many programs contain a copy of rclpy's ``wait_for_message``, which uses this class.
"""

from typing import Any

from navette.runtime.context import Context
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.handles import Handle
from navette.runtime.subscription import Subscription


class PollSet:
    """Waits until one of its subscriptions or guard conditions is ready.

    Events run while it waits. The sizes of rclpy's constructor are accepted and
    ignored: the set grows as needed.
    """

    def __init__(
        self,
        number_of_subscriptions: int,
        number_of_guard_conditions: int,
        number_of_timers: int,
        number_of_clients: int,
        number_of_services: int,
        number_of_events: int,
        context: Handle,
    ) -> None:
        self._context: Context = context.entity
        self.clear_entities()

    def clear_entities(self) -> None:
        self._subscriptions: list[Subscription[Any]] = []
        self._guards: list[GuardCondition] = []
        self._ready: dict[str, list[bool]] = {}

    def add_subscription(self, handle: Handle) -> int:
        """Add a subscription, ready when a sample is queued; return its index."""
        self._subscriptions.append(handle.entity)
        return len(self._subscriptions) - 1

    def add_guard_condition(self, handle: Handle) -> int:
        """Add a guard condition, ready when triggered; return its index."""
        self._guards.append(handle.entity)
        return len(self._guards) - 1

    def wait(self, timeout_ns: int = -1) -> None:
        """Wait until an entity is ready; a negative timeout waits indefinitely."""
        loop = self._context.loop
        until_ns = loop.clock.now_ns + timeout_ns if timeout_ns >= 0 else None
        loop.run(until_ns=until_ns, done=self._update)
        self._update()

    def is_ready(self, entity_type: str, index: int) -> bool:
        """Return whether that entity was ready after the last :meth:`wait`.

        Args:
            entity_type: ``"subscription"`` or ``"guard_condition"``.
            index: from :meth:`add_subscription` or :meth:`add_guard_condition`.
        """
        return self._ready.get(entity_type, [])[index]

    def get_ready_entities(self, entity_type: str) -> list[int]:
        """Return the pointers of the ready entities of that type."""
        entities: dict[str, list[Any]] = {
            "subscription": self._subscriptions,
            "guard_condition": self._guards,
        }
        marked = zip(
            entities.get(entity_type, []), self._ready.get(entity_type, []), strict=True
        )
        return [id(entity) for entity, is_ready in marked if is_ready]

    def _update(self) -> bool:
        self._ready = {
            "subscription": [each.has_samples for each in self._subscriptions],
            "guard_condition": [each.is_triggered for each in self._guards],
        }
        return any(any(each) for each in self._ready.values())
