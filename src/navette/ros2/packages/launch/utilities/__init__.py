"""ROS 2's ``launch.utilities``, as far as launch files use it."""

from navette.ros2.packages.launch.launch_description_entity import (
    normalize_to_list_of_entities,
)
from navette.ros2.packages.launch.substitution import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

__all__ = [
    "normalize_to_list_of_entities",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
]
