"""``python -m navette.cli.zygote``: imports what every small node needs, then splits.

Started by ``navette.processes``; whatever else a program needs, it imports itself.
"""

import navette.cli.run
import navette.interop.process
import navette.interop.ros2.rclpy.node
import navette.interop.targets
import navette.msgs.geometry_msgs.msg
import navette.msgs.rcl_interfaces.srv
import navette.msgs.std_msgs.msg
import navette.packages
import navette.runtime
import navette.transports.zenoh.transport  # noqa: F401 - only loaded, all of them
from navette.processes.zygote import main

if __name__ == "__main__":
    main()
