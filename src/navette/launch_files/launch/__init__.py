"""ROS 2's ``launch``: descriptions of what to start, and the service that runs them."""

from navette.launch_files.launch import (
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
from navette.launch_files.launch.action import Action
from navette.launch_files.launch.condition import Condition
from navette.launch_files.launch.errors import InvalidLaunchFileError
from navette.launch_files.launch.event import Event
from navette.launch_files.launch.event_handler import EventHandler
from navette.launch_files.launch.launch_context import LaunchContext
from navette.launch_files.launch.launch_description import LaunchDescription
from navette.launch_files.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    SomeEntitiesType,
    SomeEntitiesType_types_tuple,
)
from navette.launch_files.launch.launch_description_source import (
    LaunchDescriptionSource,
)
from navette.launch_files.launch.launch_introspector import LaunchIntrospector
from navette.launch_files.launch.launch_service import LaunchService
from navette.launch_files.launch.substitution import (
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
