"""Base class of everything that a launch description contains."""

import asyncio
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeAlias

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext

_OWN_FOLDER = str(Path(__file__).parent.parent)


class LaunchDescriptionEntity:
    """Node of the tree that a launch visits.

    ``origin`` is where it was written, as ``file:line``.
    """

    origin: str = ""

    def visit(self, context: LaunchContext) -> "list[LaunchDescriptionEntity] | None":
        """Do the work; return the entities to visit next. The default does nothing."""
        return None

    def describe(self) -> str:
        """Describe the entity in an error message or a listing."""
        return type(self).__name__

    def describe_sub_entities(self) -> "list[LaunchDescriptionEntity]":
        """Return the entities inside, as far as they are known without running."""
        return []

    def describe_conditional_sub_entities(
        self,
    ) -> "list[tuple[str, Iterable[LaunchDescriptionEntity]]]":
        """Return entities that may be visited, each list with its condition."""
        return []

    def get_asyncio_future(self) -> "asyncio.Future[Any] | None":
        """Return a future that the launch waits for; called after the visit."""
        return None


SomeEntitiesType: TypeAlias = (
    LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
)
SomeEntitiesType_types_tuple = (LaunchDescriptionEntity, Iterable)


def normalize_to_list_of_entities(value: Any) -> list[LaunchDescriptionEntity]:
    """Convert one entity, several (also nested lists), or None to a flat list.

    Raises:
        InvalidLaunchValueError: an item is not a launch entity.
    """
    if value is None:
        return []
    if isinstance(value, LaunchDescriptionEntity):
        return [value]
    if isinstance(value, Iterable) and not isinstance(value, (str, bytes, dict)):
        return [
            entity for item in value for entity in normalize_to_list_of_entities(item)
        ]
    raise InvalidLaunchValueError(
        f"{value!r} ({type(value).__name__}): expected an action or a list of actions"
    )


def caller_location() -> str:
    """Return ``file:line`` of the nearest caller outside this folder."""
    frame = sys._getframe(1)
    while frame.f_code.co_filename.startswith(_OWN_FOLDER) and frame.f_back is not None:
        frame = frame.f_back
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"
