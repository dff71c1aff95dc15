"""ament_index_python: folders of packages and resources."""

from navette.ros2.packages.ament_index_python.constants import RESOURCE_INDEX_SUBFOLDER
from navette.ros2.packages.ament_index_python.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
)
from navette.ros2.packages.ament_index_python.resources import (
    InvalidResourceNameError,
    InvalidResourceTypeNameError,
    get_resource,
    get_resource_types,
    get_resources,
    has_resource,
)
from navette.ros2.packages.ament_index_python.search_paths import get_search_paths
