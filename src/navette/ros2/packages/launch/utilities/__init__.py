"""ROS 2's ``launch.utilities``."""

from navette.ros2.packages.launch.launch_description_entity import (
    normalize_to_list_of_entities,
)
from navette.ros2.packages.launch.substitution import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from navette.ros2.packages.launch.utilities import (
    class_tools_impl,
    type_utils,
    visiting,
)
from navette.ros2.packages.launch.utilities.class_tools_impl import (
    ensure_argument_type,
    is_a,
    is_a_subclass,
    isclassinstance,
)
from navette.ros2.packages.launch.utilities.signal_management import (
    AsyncSafeSignalManager,
)
from navette.ros2.packages.launch.utilities.visiting import (
    create_future,
    visit_all_entities_and_collect_futures,
)

__all__ = [
    "AsyncSafeSignalManager",
    "class_tools_impl",
    "create_future",
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "isclassinstance",
    "normalize_to_list_of_entities",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
    "type_utils",
    "visit_all_entities_and_collect_futures",
    "visiting",
]
