"""A small node of four topics that reports when it has discovered all others.

``one_of_many.py NUMBER OF``: the node's number, and the number of nodes.
"""

import os
import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import String

NUMBER, OF = (int(word) for word in rclpy.utilities.remove_ros_args(sys.argv)[1:3])
TOPICS = 4
LOOK_S = 0.1
# Not at each look, because output is not part of the measurement.
LOOKS_PER_REPORT = 20


def cpu_time() -> float:
    """CPU time of this process in seconds."""
    return sum(os.times()[:2])


# After the imports, before the network is joined.
START_CPU_S = cpu_time()


class OneOfMany(Node):
    """Publishes nothing; counts nodes and topics."""

    def __init__(self) -> None:
        super().__init__(f"one_{NUMBER}")
        self.publishers_ = [
            self.create_publisher(String, f"/many/n{NUMBER}/t{topic}", 1)
            for topic in range(TOPICS)
        ]
        self._looks = 0
        self._timer = self.create_timer(LOOK_S, self._look)

    def _look(self) -> None:
        nodes = sum(name.startswith("one_") for name in self.get_node_names())
        topics = 0
        if nodes == OF:  # topics are discovered with their nodes
            found = self.get_topic_names_and_types()
            topics = sum(name.startswith("/many/") for name, _ in found)
        self._looks += 1
        if self._looks % LOOKS_PER_REPORT == 0:
            sys.stdout.write(f"{NUMBER} sees {nodes} nodes {topics} topics\n")
        if (nodes, topics) == (OF, OF * TOPICS):
            self._timer.cancel()
            cpu_s = cpu_time() - START_CPU_S
            sys.stdout.write(
                f"{NUMBER} sees all: {nodes} nodes {topics} topics {cpu_s:.3f} s CPU\n"
            )


def main() -> None:
    rclpy.init()
    node = OneOfMany()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
        sys.stdout.write(f"{NUMBER} used {cpu_time():.3f} s CPU\n")


if __name__ == "__main__":
    main()
