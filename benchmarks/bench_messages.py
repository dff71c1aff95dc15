"""Messages: deep copy, to CDR and back, compared with rosbags and mcap-ros2-support.

All produce the same bytes (rosbags' and Navette's are compared, and mcap-ros2-support's
fields after reading).
"""

import copy
from typing import Any

import numpy as np
from harness import Benchmark, optional

from navette.msgs import copy_message, definition_text, deserialize, serialize
from navette.msgs.base import Message
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.sensor_msgs.msg import LaserScan

rosbags: Any = optional("rosbags.typesys")
mcap_ros2: Any = optional("mcap_ros2._dynamic")


def some_messages() -> dict[str, Message]:
    """From 48 bytes to 160 kB."""
    rng = np.random.default_rng(0)
    twist = Twist()
    twist.linear.x, twist.angular.z = 0.5, -0.25
    odometry = Odometry(child_frame_id="base_link")
    odometry.header.frame_id = "odom"
    odometry.pose.pose.orientation.w = 1.0
    scan = LaserScan(ranges=rng.uniform(0.1, 30.0, 720).astype(np.float32))
    scan.header.frame_id = "lidar"
    grid = OccupancyGrid(data=rng.integers(-1, 101, 400 * 400).astype(np.int8))
    grid.info.width = grid.info.height = 400
    return {
        "Twist": twist,
        "Odometry": odometry,
        "LaserScan, 720 beams": scan,
        "OccupancyGrid, 400²": grid,
    }


class RosbagsPeer:
    """rosbags' own classes and its CDR codec."""

    def __init__(self, message: Message) -> None:
        self.store = rosbags.get_typestore(rosbags.Stores.ROS2_JAZZY)
        self.type = type(message)._type_name_
        self.data = serialize(message)
        self.message = self.read()
        assert bytes(self.write()) == self.data

    def read(self) -> Any:
        return self.store.deserialize_cdr(self.data, self.type)

    def write(self) -> Any:
        return self.store.serialize_cdr(self.message, self.type)


class McapPeer:
    """mcap-ros2-support: generated functions, plain namespaces."""

    def __init__(self, message: Message) -> None:
        name = type(message)._type_name_
        text = definition_text(name)
        self._decode = mcap_ros2.generate_dynamic(name, text)[name]
        self._encode = mcap_ros2.serialize_dynamic(name, text)[name]
        self.data = serialize(message)
        self.message = self.read()
        again = deserialize(bytes(self.write()), type(message))
        assert again == message

    def read(self) -> Any:
        return self._decode(self.data)

    def write(self) -> Any:
        return self._encode(self.message)


def main() -> None:
    bench = Benchmark("messages", __doc__, budget_s=0.7)
    for name, message in some_messages().items():
        data = serialize(message)
        assert deserialize(data, type(message)) == message == copy_message(message)
        bench.case(
            f"{name}: copy",
            {
                "navette": lambda m=message: copy_message(m),
                "copy.deepcopy": lambda m=message: copy.deepcopy(m),
            },
            "copies are equal",
        )
        writers: dict[str, Any] = {"navette": lambda m=message: serialize(m)}
        cls = type(message)
        readers: dict[str, Any] = {"navette": lambda d=data, c=cls: deserialize(d, c)}
        for peer, module, make in (
            ("rosbags", rosbags, RosbagsPeer),
            ("mcap-ros2-support", mcap_ros2, McapPeer),
        ):
            if module is not None:
                made = make(message)
                writers[peer], readers[peer] = made.write, made.read
        bench.case(f"{name}: to CDR", writers, "bytes are equal")
        bench.case(f"{name}: from CDR", readers, "fields are equal")
    bench.main()


if __name__ == "__main__":
    main()
