"""Guard conditions: callbacks that any thread can trigger."""

from collections.abc import Callable
from typing import Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.context import Context, get_default_context
from navette.runtime.destroyable import EntityOwner
from navette.runtime.events import Entity
from navette.runtime.handles import Handle


class GuardCondition(Entity):
    """Runs a callback after :meth:`trigger`. Created by ``create_guard_condition``.

    Triggers before the callback has started count as one. A guard condition without
    an owner belongs to no node: its callback runs whenever the context's loop runs.
    """

    __slots__ = ("_loop", "_node_name", "_owner", "_triggered", "callback")

    def __init__(
        self,
        callback: Callable[[], Any] | None = None,
        callback_group: CallbackGroup | None = None,
        context: Context | None = None,
        *,
        node_name: str = "",
        owner: EntityOwner | None = None,
    ) -> None:
        self.callback = callback
        self._loop = (context or get_default_context()).loop
        self.group = callback_group or self._loop.free_group
        self._node_name = node_name
        self._owner = owner
        self._triggered = False

    @property
    def handle(self) -> Handle:
        """The handle that a wait set takes."""
        return Handle(self)

    @property
    def is_triggered(self) -> bool:
        """Whether the callback is still to run."""
        return self._triggered

    @property
    def callback_group(self) -> CallbackGroup:
        return self.group

    def trigger(self) -> None:
        """Queue the callback; callable from any thread."""
        if not self._triggered:
            self._triggered = True
            self._loop.ready.append(self)
            if self._loop.waiting:
                self._loop.wake()

    def run(self) -> Any:
        if not self._triggered:  # destroyed while the event was queued
            return None
        self._triggered = False
        return None if self.callback is None else self.callback()

    def origin(self) -> tuple[str, str]:
        return self._node_name, "guard condition"

    def destroy(self) -> None:
        self._triggered = False
        if self._owner is not None:
            self._owner.forget(self)
