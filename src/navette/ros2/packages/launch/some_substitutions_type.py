"""ROS 2's module of this name: the type of arguments that may be substitutions."""

from navette.ros2.packages.launch.substitution import (
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]
