"""``python -m navette.cli.zygote``: imports what every small node needs, then splits.

Started by ``navette.supervisor``; whatever else a program needs, it imports itself.
"""

import navette.cli.run
import navette.msgs.geometry_msgs.msg
import navette.msgs.rcl_interfaces.srv
import navette.msgs.std_msgs.msg
import navette.ros2.names.process
import navette.ros2.names.targets
import navette.ros2.workspace
import navette.runtime
import navette.transports.zenoh.transport  # noqa: F401 - imported for the forks
from navette.cli.app import build
from navette.msgs import type_hash
from navette.supervisor.zygote import main

# Their definitions are read, and their hashes computed, once for all.
_OF_EVERY_NODE = (
    "rcl_interfaces/msg/Log",
    "rcl_interfaces/msg/ParameterEvent",
    "rcl_interfaces/srv/DescribeParameters",
    "rcl_interfaces/srv/GetParameterTypes",
    "rcl_interfaces/srv/GetParameters",
    "rcl_interfaces/srv/ListParameters",
    "rcl_interfaces/srv/SetParameters",
    "rcl_interfaces/srv/SetParametersAtomically",
    "type_description_interfaces/srv/GetTypeDescription",
)

if __name__ == "__main__":
    for name in _OF_EVERY_NODE:
        type_hash(name)
    build("run")
    main()
