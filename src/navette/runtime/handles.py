"""rclpy's handles, as far as programs use them: to poll instead of being called back.

Many programs have a copy of rclpy's ``wait_for_message``, which is made of these.
"""

from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from navette.runtime.context import Context
    from navette.runtime.guard_condition import GuardCondition
    from navette.runtime.subscription import MessageInfo, Subscription


class Handle:
    """Stands for an entity; ``with handle: …`` does nothing here."""

    def __init__(self, entity: Any) -> None:
        self.entity = entity

    @property
    def pointer(self) -> int:
        """A number that no other entity has while this one lives."""
        return id(self.entity)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing to let go of."""


class SubscriptionHandle(Handle):
    """Of a subscription."""

    entity: "Subscription[Any]"

    def take_message(
        self, msg_type: type, raw: bool
    ) -> "tuple[Any, MessageInfo] | None":
        """The oldest sample of the queue (its bytes, if ``raw``), or None."""
        return self.entity.take_with_info(raw=raw)


class PollSet:
    """Waits until one of several subscriptions or guard conditions is ready.

    rclpy's inner ``WaitSet``; it grows as needed, whatever sizes it is given. Events
    run meanwhile, as in every wait.
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
        """Wait for nothing."""
        self._subscriptions: list[Subscription[Any]] = []
        self._guards: list[GuardCondition] = []
        self._ready: dict[str, list[bool]] = {}

    def add_subscription(self, handle: Handle) -> int:
        """Wait for a sample in its queue; gives its index."""
        self._subscriptions.append(handle.entity)
        return len(self._subscriptions) - 1

    def add_guard_condition(self, handle: Handle) -> int:
        """Wait for its trigger; gives its index."""
        self._guards.append(handle.entity)
        return len(self._guards) - 1

    def wait(self, timeout_ns: int = -1) -> None:
        """Until something is ready or the time is over (below 0: for ever)."""
        loop = self._context.loop
        until_ns = loop.clock.now_ns + timeout_ns if timeout_ns >= 0 else None
        loop.run(until_ns=until_ns, done=self._look)
        self._look()

    def is_ready(self, entity_type: str, index: int) -> bool:
        """Whether that one was ready (``"subscription"``, ``"guard_condition"``)."""
        return self._ready.get(entity_type, [])[index]

    def get_ready_entities(self, entity_type: str) -> list[int]:
        """The pointers of those that were ready."""
        entities: dict[str, list[Any]] = {
            "subscription": self._subscriptions,
            "guard_condition": self._guards,
        }
        marked = zip(
            entities.get(entity_type, []), self._ready.get(entity_type, []), strict=True
        )
        return [id(entity) for entity, is_ready in marked if is_ready]

    def _look(self) -> bool:
        self._ready = {
            "subscription": [each.has_samples for each in self._subscriptions],
            "guard_condition": [each.is_triggered for each in self._guards],
        }
        return any(any(each) for each in self._ready.values())
