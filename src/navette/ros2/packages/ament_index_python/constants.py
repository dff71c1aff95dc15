"""ament_index_python.constants."""

from navette.ros2.workspace.finding import AMENT_VARIABLE

AMENT_PREFIX_PATH_ENV_VAR = AMENT_VARIABLE
RESOURCE_INDEX_SUBFOLDER = "share/ament_index/resource_index"
