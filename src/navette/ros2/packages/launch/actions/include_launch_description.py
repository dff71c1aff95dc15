"""Includes of other launch descriptions."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.actions.arguments import SetLaunchConfiguration
from navette.ros2.packages.launch.actions.opaque_function import OpaqueFunction
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    LaunchDescriptionSource,
)
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.substitution import Parts

_LOCALS = ("current_launch_file_path", "current_launch_file_directory")
MAX_DEPTH = 50

_log = get_logger("launch")


class IncludeLaunchDescription(Action):
    """Sets ``launch_arguments`` and visits a launch description.

    As in ROS 2, the arguments stay set afterwards; use a GroupAction to limit them.

    Args:
        launch_description_source: a source, or a path (any format).
        launch_arguments: (name, value) pairs.
    """

    def __init__(
        self,
        launch_description_source: Any,
        *,
        launch_arguments: Iterable[tuple[Any, Any]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if isinstance(launch_description_source, LaunchDescription):
            launch_description_source = LaunchDescriptionSource(
                launch_description_source
            )
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(
                launch_description_source
            )
        self.source: LaunchDescriptionSource = launch_description_source
        if isinstance(launch_arguments, dict):
            raise InvalidLaunchValueError(
                "IncludeLaunchDescription: launch_arguments is a dict; write "
                "launch_arguments={…}.items()"
            )
        self.launch_arguments = [
            (
                Parts.of(name),
                Parts.of(value),
            )
            for name, value in launch_arguments or ()
        ]

    @property
    def launch_description_source(self) -> LaunchDescriptionSource:
        return self.source

    @property
    def included_file(self) -> Path | None:
        """The file; None until it has been read."""
        return self.source.path

    def describe(self) -> str:
        return f"IncludeLaunchDescription({self.source.location})"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the description if it is available without running."""
        loaded = self.source.try_get_launch_description_without_context()
        return [] if loaded is None else [loaded]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        description = self.source.get_launch_description(context)
        given = [
            (name.perform(context), value) for name, value in self.launch_arguments
        ]
        self._check(description, [name for name, _ in given], context)
        depth = context.get_locals_as_dict().get("include depth", 0) + 1
        if depth > MAX_DEPTH:
            raise InvalidLaunchValueError(
                f"includes nested deeper than {MAX_DEPTH}; check for a file that "
                "includes itself"
            )
        path = self.source.path
        return [
            OpaqueFunction(function=_enter, args=[path, depth]),
            *(SetLaunchConfiguration(name, value) for name, value in given),
            description,
            OpaqueFunction(function=_leave),
        ]

    def _check(
        self, description: LaunchDescription, given: list[str], context: LaunchContext
    ) -> None:
        """Raise for missing arguments; warn of undeclared ones."""
        declared = {each.name: each for each in description.get_launch_arguments()}
        missing = [
            each.name
            for each in declared.values()
            if each.default_value is None
            and each.condition is None
            and each.name not in given
            and each.name not in context.launch_configurations
        ]
        if missing:
            raise InvalidLaunchValueError(
                f"{self.source.location} requires these arguments: {', '.join(missing)}"
            )
        undeclared = sorted({name for name in given if name not in declared})
        if undeclared and declared:
            _log.warning(
                "%s: %s declares no argument %s; declared: %s",
                self.origin,
                self.source.location,
                ", ".join(map(repr, undeclared)),
                ", ".join(declared),
            )


def _enter(context: LaunchContext, path: Any, depth: int) -> None:
    context.push_locals()
    context.extend_locals({"include depth": depth})
    if path is not None:
        context.extend_locals(
            dict(zip(_LOCALS, (str(path), str(path.parent)), strict=True))
        )


def _leave(context: LaunchContext) -> None:
    context.pop_locals()
