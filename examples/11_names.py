"""Names: global, relative and private ones, a namespace, and remapping from outside.

The node below never changes; what its names mean is said by who starts it: here by the
arguments of ``navette.init``, on the command line by
``navette run 11_names.py --ros-args -r …``, in a launch file by ``remappings``.

Prints::

    as written, in namespace /left:
        /clock_of_all  <- /clock_of_all
        speed          <- /left/speed
        wheel/speed    <- /left/wheel/speed
        ~/state        <- /left/drive/state
    with -r __ns:=/right -r __node:=motor -r speed:=velocity -r ~/state:=/state:
        /clock_of_all  <- /clock_of_all
        speed          <- /right/velocity
        wheel/speed    <- /right/wheel/speed
        ~/state        <- /state
"""

import navette
from navette.msgs.std_msgs.msg import Empty

NAMES = ("/clock_of_all", "speed", "wheel/speed", "~/state")


class Drive(navette.Node):
    def __init__(self, **arguments):
        super().__init__("drive", **arguments)
        self.topics = {
            name: self.create_publisher(Empty, name, 10).topic_name for name in NAMES
        }


def show(arguments, **of_node):
    with navette.init(args=arguments, clock=navette.VirtualClock()):
        for name, topic in Drive(**of_node).topics.items():
            print(f"    {name:14} <- {topic}")


print("as written, in namespace /left:")
show([], namespace="/left")
rules = "-r __ns:=/right -r __node:=motor -r speed:=velocity -r ~/state:=/state"
print(f"with {rules}:")
show(["--ros-args", *rules.split()])
