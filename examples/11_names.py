"""Names: global, relative and private names, namespaces and remapping.

The node's code stays the same. Its names are remapped by the arguments of
``navette.init`` here, by ``navette run 11_names.py --ros-args -r …`` on the command
line, and by ``remappings`` in a launch file.

Prints::

    as written, in namespace /left:
        /shared_clock  <- /shared_clock
        speed          <- /left/speed
        wheel/speed    <- /left/wheel/speed
        ~/state        <- /left/drive/state
    with -r __ns:=/right -r __node:=motor -r speed:=velocity -r ~/state:=/state:
        /shared_clock  <- /shared_clock
        speed          <- /right/velocity
        wheel/speed    <- /right/wheel/speed
        ~/state        <- /state
"""

import navette
from navette.msgs.std_msgs.msg import Empty

NAMES = ("/shared_clock", "speed", "wheel/speed", "~/state")


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
