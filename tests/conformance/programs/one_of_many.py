"""A small node of four topics: says when it sees all that are to be there.

``one_of_many.py NUMBER OF``: the node's number, and how many there are.
"""

import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import String

NUMBER, OF = (int(word) for word in rclpy.utilities.remove_ros_args(sys.argv)[1:3])
TOPICS = 4
LOOK_S = 0.1
# Not each time: what is measured is not how fast fifty programs can write.
LOOKS_A_REPORT = 20


class OneOfMany(Node):
    """Publishes nothing; counts the others."""

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
        if nodes == OF:  # the topics come with them
            told = self.get_topic_names_and_types()
            topics = sum(name.startswith("/many/") for name, _ in told)
        self._looks += 1
        if self._looks % LOOKS_A_REPORT == 0:
            sys.stdout.write(f"{NUMBER} sees {nodes} nodes {topics} topics\n")
        if (nodes, topics) == (OF, OF * TOPICS):
            self._timer.cancel()
            sys.stdout.write(f"{NUMBER} sees all: {nodes} nodes {topics} topics\n")


def main() -> None:
    rclpy.init()
    node = OneOfMany()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
