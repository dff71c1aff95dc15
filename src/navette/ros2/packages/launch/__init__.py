"""ROS 2's ``launch``: descriptions of what to start, and the service that runs them."""

from navette.ros2.packages.launch import (
    actions,
    conditions,
    descriptions,
    event_handlers,
    events,
    frontend,
    launch_description_sources,
    logging,
    substitutions,
    utilities,
)
from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.condition import Condition
from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import EventHandler
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    SomeEntitiesType,
    SomeEntitiesType_types_tuple,
)
from navette.ros2.packages.launch.launch_description_sources import (
    LaunchDescriptionSource,
)
from navette.ros2.packages.launch.launch_introspector import LaunchIntrospector
from navette.ros2.packages.launch.launch_service import LaunchService
from navette.ros2.packages.launch.substitution import (
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
    Substitution,
)

__all__ = [
    "actions",
    "conditions",
    "descriptions",
    "event_handlers",
    "events",
    "frontend",
    "launch_description_sources",
    "logging",
    "substitutions",
    "utilities",
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "InvalidLaunchFileError",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchIntrospector",
    "LaunchService",
    "SomeEntitiesType",
    "SomeEntitiesType_types_tuple",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
]
