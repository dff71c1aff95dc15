"""Action that calls a function of the launch file."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    normalize_to_list_of_entities,
)


class OpaqueFunction(Action):
    """Calls ``function(context, *args, **kwargs)``; visits the entities it returns."""

    def __init__(
        self,
        *,
        function: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **left_over: Any,
    ) -> None:
        super().__init__(**left_over)
        if not callable(function):
            raise InvalidLaunchValueError(
                f"OpaqueFunction: function {function!r} is not callable"
            )
        self._function = function
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})

    def describe(self) -> str:
        name = getattr(self._function, "__name__", repr(self._function))
        return f"OpaqueFunction({name})"

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        return normalize_to_list_of_entities(
            self._function(context, *self._args, **self._kwargs)
        )
