"""ROS 2's ``launch_ros.utilities``."""

from navette.ros2.packages.launch_ros.utilities.namespaces import (
    is_namespace_absolute,
    is_root_namespace,
    make_namespace_absolute,
    prefix_namespace,
)
from navette.ros2.packages.launch_ros.utilities.node_names import (
    add_node_name,
    get_node_name_count,
)
from navette.ros2.packages.launch_ros.utilities.parameters import (
    evaluate_parameter_dict,
    evaluate_parameters,
    normalize_parameter_dict,
    normalize_parameters,
    to_parameters_list,
)
from navette.ros2.packages.launch_ros.utilities.remap_rules import (
    normalize_remap_rule,
    normalize_remap_rules,
)

__all__ = [
    "add_node_name",
    "evaluate_parameter_dict",
    "evaluate_parameters",
    "get_node_name_count",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "normalize_parameter_dict",
    "normalize_parameters",
    "normalize_remap_rule",
    "normalize_remap_rules",
    "prefix_namespace",
    "to_parameters_list",
]
