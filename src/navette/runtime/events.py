"""What the loop runs: entities, and plain calls."""

from collections.abc import Callable
from typing import Any

from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.future import Task


class Entity:
    """Something the loop can run: a subscription, a timer, a plain call."""

    __slots__ = ("group",)

    #: Whether it runs while its group is held by a callback that waits for a service
    #: or an action, blocking or in an ``await``: what it waits for may be in that very
    #: group.
    answers_calls = False

    group: CallbackGroup

    def run(self) -> Any:
        """Do one event's work; a returned coroutine is run as a task."""
        raise NotImplementedError

    def waiting_group(self) -> CallbackGroup | None:
        """The group that is held while this waits in a blocking call."""
        return self.group

    def origin(self) -> tuple[str, str]:
        """Full name of the node and the topic or timer, for error messages."""
        return "", type(self).__name__


class Call(Entity):
    """A plain function call; :meth:`cancel` keeps it from happening."""

    __slots__ = ("_function", "_node", "_source", "token")

    def __init__(
        self,
        function: Callable[[], Any],
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
        self._function = _nothing


def _nothing() -> None:
    """What a cancelled call does."""
