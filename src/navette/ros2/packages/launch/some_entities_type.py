"""ROS 2's module of this name: the type of arguments that may be several entities."""

from navette.ros2.packages.launch.launch_description_entity import (
    SomeEntitiesType,
    SomeEntitiesType_types_tuple,
)

__all__ = ["SomeEntitiesType", "SomeEntitiesType_types_tuple"]
