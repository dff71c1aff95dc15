"""Imports that every node needs, for the fork server of ``navette launch``."""

import gc

import navette.cli.app
import navette.cli.run
import navette.msgs.geometry_msgs.msg
import navette.msgs.rcl_interfaces.srv
import navette.msgs.std_msgs.msg
import navette.ros2.names.process
import navette.ros2.names.targets
import navette.ros2.workspace
import navette.runtime
import navette.runtime.parameter_files
import navette.transports.zenoh.transport  # noqa: F401 - imported for the forks
from navette.msgs import type_hash

# Read the definitions of the interfaces of every node, and compute their hashes.
for _name in (
    "rcl_interfaces/msg/Log",
    "rcl_interfaces/msg/ParameterEvent",
    "rcl_interfaces/srv/DescribeParameters",
    "rcl_interfaces/srv/GetParameterTypes",
    "rcl_interfaces/srv/GetParameters",
    "rcl_interfaces/srv/ListParameters",
    "rcl_interfaces/srv/SetParameters",
    "rcl_interfaces/srv/SetParametersAtomically",
    "type_description_interfaces/srv/GetTypeDescription",
):
    type_hash(_name)

# The forks share the pages of these objects.
gc.collect()
gc.freeze()
