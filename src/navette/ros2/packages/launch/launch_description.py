"""Launch description: the entities of one launch file."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
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
        for argument, _ in self.get_launch_arguments_with_includes():
            found.setdefault(argument.name, argument)
        return list(found.values())

    def get_launch_arguments_with_includes(self) -> list[tuple[Any, tuple[Any, ...]]]:
        """Return each declaration with the includes around it, outer ones first."""
        found = []
        for entity, path in _walk(self):
            if getattr(entity, "declares", None) is not None:
                entity._conditionally_included = path.is_conditional
                found.append((entity, path.includes))
        return found


@dataclass(frozen=True)
class _Path:
    """How a walk arrived at an entity."""

    is_conditional: bool = False
    includes: tuple[Any, ...] = ()


def walk(root: LaunchDescriptionEntity) -> Iterable[Any]:
    """Yield ``root`` and everything that it is known to lead to, in order.

    A file that includes itself (under a condition) is entered once.
    """
    return (entity for entity, _ in _walk(root))


_START = _Path()


def _walk(root: Any, path: _Path = _START) -> Iterable[tuple[Any, _Path]]:
    if getattr(root, "condition", None) is not None:
        path = replace(path, is_conditional=True)
    yield root, path
    inside = [(path, root.describe_sub_entities())]
    under_condition = replace(path, is_conditional=True)
    for _, entities in root.describe_conditional_sub_entities():
        inside.append((under_condition, entities))
    file = getattr(root, "included_file", None)  # known after it has been described
    if file is not None and file in [each.included_file for each in path.includes]:
        return
    outer = (*path.includes, root) if hasattr(root, "argument_names") else path.includes
    for inner, entities in inside:
        for entity in entities:
            if getattr(entity, "resets_arguments", False):
                break  # nothing from outside holds after it
            yield from _walk(entity, replace(inner, includes=outer))
