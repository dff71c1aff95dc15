"""Includes of other launch descriptions."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.actions.arguments import SetLaunchConfiguration
from navette.ros2.packages.launch.actions.opaque_function import OpaqueFunction
from navette.ros2.packages.launch.errors import InvalidLaunchValueError, LaunchError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    LaunchDescriptionSource,
    constant_text,
)
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.substitution import Parts

_FILE, _FOLDER = "current_launch_file_path", "current_launch_file_directory"
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
    def argument_names(self) -> list[str]:
        """Names of the given arguments, as far as they are constant."""
        texts = (constant_text(name) for name, _ in self.launch_arguments)
        return [text for text in texts if text is not None]

    @property
    def included_file(self) -> Path | None:
        """The file; None until it has been read."""
        return self.source.path

    def describe(self) -> str:
        return f"IncludeLaunchDescription({self.source.location})"

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the description if it is available without running."""
        loaded = self.source.try_get_launch_description_without_context()
        return [] if loaded is None else [loaded]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        description = self.source.get_launch_description(context)
        given = [
            (name.perform(context), value) for name, value in self.launch_arguments
        ]
        self._check(description, [name for name, _ in given], context)
        leave = self._enter(context)
        return [
            *(SetLaunchConfiguration(name, value) for name, value in given),
            description,
            *leave,
        ]

    def _enter(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Set the launch file of the scope; return what restores that of the outer."""
        outer = context.get_locals_as_dict()
        leave: list[LaunchDescriptionEntity] = []
        if _FILE in outer:
            depth = outer.get("include depth", 0) + 1
            if depth > MAX_DEPTH:
                raise InvalidLaunchValueError(
                    f"includes nested deeper than {MAX_DEPTH}; check for a file that "
                    "includes itself"
                )
            context._push_locals()
            context.extend_locals({"include depth": depth})
            leave.append(OpaqueFunction(function=_leave))
        if self.source.path is not None:
            folder = str(self.source.path.parent)
            context.extend_locals({_FILE: str(self.source.path), _FOLDER: folder})
        elif _FILE not in outer:
            place = self.source.location
            context.extend_locals({_FILE: place, _FOLDER: place})
        return leave

    def _check(
        self, description: LaunchDescription, given: list[str], context: LaunchContext
    ) -> None:
        """Raise for missing arguments; warn of undeclared ones.

        As in ROS 2, an argument must be given by this include or by one inside that
        leads to its declaration; arguments of the whole launch count for its own files.
        """
        declared = description.get_launch_arguments_with_includes()
        names = {argument.name for argument, _ in declared}
        is_of_launch = _FILE not in context.get_locals_as_dict()
        of_launch = list(context.launch_configurations) if is_of_launch else []
        missing = []
        for argument, includes in declared:
            inside = [name for each in includes for name in each.argument_names]
            is_optional = argument.default_value is not None
            if not (
                is_optional
                or argument._conditionally_included
                or argument.name in (*given, *of_launch, *inside)
            ):
                if is_of_launch:  # no file has this include: name the declaration
                    where, entity = argument.origin, argument.describe()
                    raise LaunchError.at(where, entity, argument.not_given())
                missing.append(argument.name)
        if missing:
            raise InvalidLaunchValueError(
                f"Included launch description missing required argument "
                f"{', '.join(map(repr, missing))}: {self.source.location} (given: "
                f"{', '.join(given) or 'none'})"
            )
        undeclared = sorted({name for name in given if name not in names})
        if undeclared and names:
            _log.warning(
                "%s: %s declares no argument %s; declared: %s",
                self.origin,
                self.source.location,
                ", ".join(map(repr, undeclared)),
                ", ".join(sorted(names)),
            )


def _leave(context: LaunchContext) -> None:
    context._pop_locals()
