"""Events of the loop: entities with callbacks, and plain function calls."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.future import Task

Function = Callable[[], Any]
"""A function that the loop calls once; a coroutine that it returns is run as a task."""


class Entity(ABC):
    """An object whose events the loop runs: a subscription, a timer, a plain call."""

    __slots__ = ("group",)

    #: Whether the entity runs while its group is held by a callback that waits for a
    #: service or an action (blocking or in an ``await``), because the server may be in
    #: the same group.
    runs_during_calls = False

    group: CallbackGroup

    @abstractmethod
    def run(self) -> Any:
        """Process one event; the loop runs a returned coroutine as a task."""

    def waiting_group(self) -> CallbackGroup | None:
        """Return the group that is held while a blocking call of this event waits."""
        return self.group

    def on_clock_set_back(self, step_ns: int) -> None:  # noqa: B027 - few store times
        """Move stored times of the context's clock by ``step_ns`` (< 0)."""

    def origin(self) -> tuple[str, str]:
        """Return the node's full name and the topic or timer, for error messages."""
        return "", type(self).__name__


class Call(Entity):
    """A function call that can be cancelled before it runs."""

    __slots__ = ("_function", "_node", "_source", "token")

    def __init__(
        self,
        function: Function,
        group: CallbackGroup,
        source: str,
        node: str,
    ) -> None:
        self._function = function
        self.group = group
        self._source = source
        self._node = node
        self.token = 0

    def run(self) -> Any:
        return self._function()

    def origin(self) -> tuple[str, str]:
        return self._node, self._source

    def waiting_group(self) -> CallbackGroup | None:
        return self._function.group if isinstance(self._function, Task) else self.group

    def cancel(self) -> None:
        self.token = -1
        self._function = _do_nothing


def _do_nothing() -> None:
    return
