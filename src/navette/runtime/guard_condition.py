"""Guard conditions: a callback that any thread can ask for."""

from collections.abc import Callable
from typing import Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.context import Context, get_default_context
from navette.runtime.events import Entity
from navette.runtime.handles import Handle


class GuardCondition(Entity):
    """Calls back soon after :meth:`trigger`. Made by ``create_guard_condition``.

    One that is made by hand belongs to no node: its callback runs whenever the
    context's loop does.
    Triggers before the callback has begun count as one.
    """

    __slots__ = ("_loop", "_node_name", "_on_destroy", "_triggered", "callback")

    def __init__(
        self,
        callback: Callable[[], Any] | None = None,
        callback_group: CallbackGroup | None = None,
        context: Context | None = None,
        *,
        node_name: str = "",
        on_destroy: Callable[["GuardCondition"], None] | None = None,
    ) -> None:
        self.callback = callback
        self._loop = (context or get_default_context()).loop
        self.group = callback_group or self._loop.free_group
        self._node_name = node_name
        self._on_destroy = on_destroy
        self._triggered = False

    @property
    def handle(self) -> Handle:
        """What a wait set takes."""
        return Handle(self)

    @property
    def is_triggered(self) -> bool:
        """Whether its callback has still to run."""
        return self._triggered

    @property
    def callback_group(self) -> CallbackGroup:
        return self.group

    def trigger(self) -> None:
        """Let the callback run; from any thread."""
        if not self._triggered:
            self._triggered = True
            self._loop.ready.append(self)
            if self._loop.waiting:
                self._loop.wake()

    def run(self) -> Any:
        if not self._triggered:  # destroyed while the event waited
            return None
        self._triggered = False
        return None if self.callback is None else self.callback()

    def origin(self) -> tuple[str, str]:
        return self._node_name, "guard condition"

    def destroy(self) -> None:
        self._triggered = False
        if self._on_destroy is not None:
            self._on_destroy(self)
