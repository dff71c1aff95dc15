"""Guard conditions: callbacks that any thread can trigger."""

from collections.abc import Callable
from typing import Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.context import Context, get_default_context
from navette.runtime.events import Entity
from navette.runtime.handles import HasHandle
from navette.runtime.node_entities import NodeEntities


class GuardCondition(HasHandle, Entity):
    """Runs a callback after :meth:`trigger`. Created by ``create_guard_condition``.

    Triggers before the callback has started count as one. A guard condition without
    ``entities`` belongs to no node: its callback runs whenever the loop runs.
    """

    __slots__ = ("_entities", "_loop", "_triggered", "callback")

    def __init__(
        self,
        callback: Callable[[], Any] | None = None,
        callback_group: CallbackGroup | None = None,
        context: Context | None = None,
        *,
        entities: NodeEntities | None = None,
    ) -> None:
        self.callback = callback
        self._loop = (context or get_default_context()).loop
        self.group = callback_group or self._loop.free_group
        self._entities = entities
        self._triggered = False

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
        entities = self._entities
        return "" if entities is None else entities.full_name, "guard condition"

    def destroy(self) -> None:
        self._triggered = False
        if self._entities is not None:
            self._entities.forget(self)
