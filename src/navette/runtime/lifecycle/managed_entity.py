"""Entities that take part in the transitions of a managed node."""

from collections.abc import Callable
from functools import wraps
from typing import Any

from navette.runtime.lifecycle.state_machine import (
    LifecycleState,
    TransitionCallbackReturn,
)


class ManagedEntity:
    """Entity whose callbacks run on transitions of its node and can reject them."""

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """Managed entity with an activation state."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., Any] | None = None,
        *,
        when_not_enabled: Callable[[], None] | None = None,
    ) -> Callable[..., Any]:
        """Decorate a method so that it runs only while the entity is activated.

        Args:
            when_not_enabled: called otherwise.
        """

        def decorate(method: Callable[..., Any]) -> Callable[..., Any]:
            @wraps(method)
            def only_when_enabled(
                self: "SimpleManagedEntity", *args: Any, **kwargs: Any
            ) -> Any:
                if self.is_activated:
                    return method(self, *args, **kwargs)
                return None if when_not_enabled is None else when_not_enabled()

            return only_when_enabled

        return decorate if wrapped is None else decorate(wrapped)
