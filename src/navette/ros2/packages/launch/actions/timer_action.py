"""Action that executes other actions after a delay."""

from collections.abc import Callable, Iterable
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.event_handler import CallbackHandler
from navette.ros2.packages.launch.events import Shutdown
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    normalize_to_list_of_entities,
)
from navette.ros2.packages.launch.typed import perform_bool, perform_seconds
from navette.runtime.events import Call


class TimerAction(Action):
    """Executes ``actions`` once, after ``period`` seconds.

    Args:
        period: seconds, or substitutions that say them.
        actions: what happens then; the scope is that of the timer.
        cancel_on_shutdown: they do not happen if the launch ends before.
    """

    completes_later = True

    def __init__(
        self,
        *,
        period: Any,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: Any = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.period = period
        self.actions = normalize_to_list_of_entities(actions)
        self.cancel_on_shutdown = cancel_on_shutdown
        self._call: Call | None = None
        self._is_waiting = False
        self._context: LaunchContext | None = None

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return list(self.actions)

    def execute(self, context: LaunchContext) -> None:
        if context.is_shutdown:
            return
        seconds = perform_seconds(context, self.period, "period")
        scope = dict(context.launch_configurations)
        local = context.get_locals_as_dict()
        self._context = context
        self._is_waiting = True
        context.busy.add(self)

        def fire() -> None:
            if not self._is_waiting:
                return  # cancelled meanwhile
            self._is_waiting = False
            context.busy.discard(self)
            context.visit_later([_Scoped(self.actions, scope, local)])
            self.complete(context)

        self.schedule(context, seconds, fire)
        if perform_bool(context, self.cancel_on_shutdown):
            context.register_event_handler(
                CallbackHandler(
                    matcher=lambda event: isinstance(event, Shutdown),
                    callback=lambda event, context: self.cancel(),
                    handle_once=True,
                )
            )

    def schedule(
        self, context: LaunchContext, seconds: float, fire: Callable[[], None]
    ) -> None:
        """Call ``fire`` on the launch's loop after ``seconds``."""
        self._call = context.call_after(seconds, fire, f"timer of {seconds:g} s")

    def cancel(self) -> None:
        """Cancel the timer; ignored after it has fired."""
        self._is_waiting = False
        if self._call is not None:
            self._call.cancel()
        if self._context is not None:
            self._context.busy.discard(self)


class _Scoped(LaunchDescriptionEntity):
    """Entities with the scope of their timer."""

    def __init__(
        self,
        entities: list[LaunchDescriptionEntity],
        configurations: dict[str, str],
        local: dict[str, Any],
    ) -> None:
        self._entities = entities
        self._configurations = configurations
        self._local = local

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        context.extend_locals(self._local)
        context._push_launch_configurations()
        context.launch_configurations.clear()
        context.launch_configurations.update(self._configurations)
        return [*self._entities, _EndOfScope()]


class _EndOfScope(LaunchDescriptionEntity):
    def visit(self, context: LaunchContext) -> None:
        context._pop_launch_configurations()
