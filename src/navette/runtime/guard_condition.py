"""Guard conditions: a callback that any thread can ask for."""

from collections.abc import Callable
from typing import Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.loop import Entity, EventLoop


class GuardCondition(Entity):
    """Calls back soon after :meth:`trigger`. Made by ``create_guard_condition``.

    Triggers before the callback has begun count as one.
    """

    __slots__ = ("_loop", "_node_name", "_on_destroy", "_triggered", "callback")

    def __init__(
        self,
        callback: Callable[[], Any] | None,
        callback_group: CallbackGroup,
        loop: EventLoop,
        node_name: str,
        on_destroy: Callable[["GuardCondition"], None],
    ) -> None:
        self.callback = callback
        self.group = callback_group
        self._loop = loop
        self._node_name = node_name
        self._on_destroy = on_destroy
        self._triggered = False

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
        self._on_destroy(self)
