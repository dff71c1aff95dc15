"""Groups of actions, by default with a scope of their own."""

from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.actions.arguments import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)
from navette.ros2.packages.launch.actions.environment import (
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    normalize_to_list_of_entities,
)


class GroupAction(Action):
    """Executes actions in order.

    Args:
        actions: what is in the group.
        scoped: configurations and environment set inside end with the group.
        forwarding: those from outside hold inside; only a scoped group can be without.
        launch_configurations: set inside.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: dict[Any, Any] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.actions = normalize_to_list_of_entities(actions)
        self.scoped = scoped
        self.forwarding = forwarding
        self.launch_configurations = dict(launch_configurations or {})

    def listed_entities(self) -> list[LaunchDescriptionEntity]:
        return list(self.actions)

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the actions, enclosed by the actions that begin and end the scope."""
        given = self.launch_configurations
        settings: list[LaunchDescriptionEntity] = [
            SetLaunchConfiguration(name, value) for name, value in given.items()
        ]
        if not self.scoped:
            return [*settings, *self.actions]
        before: list[LaunchDescriptionEntity] = [
            PushLaunchConfigurations(),
            PushEnvironment(),
        ]
        if not self.forwarding:
            before += [ResetEnvironment(), ResetLaunchConfigurations(given)]
        else:
            before += settings
        return [*before, *self.actions, PopEnvironment(), PopLaunchConfigurations()]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        return self.get_sub_entities()
