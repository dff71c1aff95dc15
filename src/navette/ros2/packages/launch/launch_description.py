"""Launch description: the entities of one launch file."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    normalize_to_list_of_entities,
)
from navette.ros2.packages.launch.logging import get_logger

_log = get_logger("launch")


class LaunchDescription(LaunchDescriptionEntity):
    """Entities that are visited in order when the launch runs."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self._entities = normalize_to_list_of_entities(initial_entities)
        self.deprecated_reason = deprecated_reason

    @property
    def deprecated(self) -> bool:
        """Whether the launch file should no longer be used."""
        return self.deprecated_reason is not None

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        return self._entities

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        self._entities += normalize_to_list_of_entities(entity)

    def add_action(self, action: LaunchDescriptionEntity) -> None:
        self.add_entity(action)

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        if self.deprecated:
            file = context.get_locals_as_dict().get("current_launch_file_path", "")
            _log.warning(f"launch file {file} is deprecated: {self.deprecated_reason}")
        return list(self._entities)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return list(self._entities)

    def get_launch_arguments(self) -> list[Any]:
        """Return the argument declarations found without running, first ones first.

        Only the first declaration of a name counts.
        """
        found: dict[str, Any] = {}
        for entity in walk(self):
            name = getattr(entity, "declares", None)
            if name is not None:
                found.setdefault(name, entity)
        return list(found.values())


def walk(
    root: LaunchDescriptionEntity, files: tuple[Path, ...] = ()
) -> Iterable[LaunchDescriptionEntity]:
    """Yield ``root`` and everything that it is known to lead to, in order.

    A file that includes itself (under a condition) is entered once.
    """
    yield root
    conditional = root.describe_conditional_sub_entities()
    inside = [*root.describe_sub_entities(), *(e for _, es in conditional for e in es)]
    file = getattr(root, "included_file", None)
    if file is not None:
        if file in files:
            return
        files = (*files, file)
    for entity in inside:
        yield from walk(entity, files)
