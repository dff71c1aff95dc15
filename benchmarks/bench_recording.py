"""Cost of recording: a drive with and without ``--record``; writing a bag alone.

Written are 2000 messages as a run has them (a scan of 720 beams among odometry),
from message objects to a closed MCAP file, beside mcap-ros2-support and rosbags.
"""

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from bench_messages import McapPeer, some_messages
from courses import SEVEN_GOALS
from harness import Benchmark, optional
from mcap.reader import make_reader

from navette.bags import BagWriter
from navette.msgs import definition_text, serialize
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

mcap_ros2: Any = optional("mcap_ros2.writer")
rosbags: Any = optional("rosbags.rosbag2")
typesys: Any = optional("rosbags.typesys")

COUNT = 2000
SECONDS = 30.0


class Writers:
    """Each contender writes the same messages to its own file."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        found = some_messages()
        odometry, scan = found["Odometry"], found["LaserScan, 720 beams"]
        self.kinds = {"/odom": odometry, "/lidar": scan}
        self.stream = [("/lidar" if i % 4 == 0 else "/odom") for i in range(COUNT)]

    def with_navette(self) -> None:
        writer = BagWriter(self.folder / "navette.mcap", overwrite=True)
        channels = {}
        for topic, message in self.kinds.items():
            name = type(message)._type_name_
            channels[topic] = writer.add_channel(topic, name, definition_text(name))
        for i, topic in enumerate(self.stream):
            writer.write(channels[topic], i * 10**7, serialize(self.kinds[topic]))
        writer.close()

    def with_mcap_ros2(self) -> Callable[[], None]:
        # It does not accept NumPy arrays: use its own objects, with lists.
        messages = {topic: McapPeer(m).message for topic, m in self.kinds.items()}
        names = {topic: type(m)._type_name_ for topic, m in self.kinds.items()}

        def run() -> None:
            with (self.folder / "mcap_ros2.mcap").open("wb") as file:
                writer = mcap_ros2.Writer(file)
                schemas = {
                    topic: writer.register_msgdef(name, definition_text(name))
                    for topic, name in names.items()
                }
                for i, topic in enumerate(self.stream):
                    ns = i * 10**7
                    writer.write_message(topic, schemas[topic], messages[topic], ns, ns)
                writer.finish()

        return run

    def with_rosbags(self) -> Callable[[], None]:
        store = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
        names = {topic: type(m)._type_name_ for topic, m in self.kinds.items()}
        messages = {
            topic: store.deserialize_cdr(serialize(m), names[topic])
            for topic, m in self.kinds.items()
        }
        runs = iter(range(10**6))

        def run() -> None:
            writer = rosbags.Writer(
                self.folder / f"rosbags_{next(runs)}",
                version=9,
                storage_plugin=rosbags.StoragePlugin.MCAP,
            )
            with writer:
                connections = {
                    topic: writer.add_connection(topic, name, typestore=store)
                    for topic, name in names.items()
                }
                for i, topic in enumerate(self.stream):
                    data = store.serialize_cdr(messages[topic], names[topic])
                    writer.write(connections[topic], i * 10**7, data)

        return run

    def check(self) -> None:
        """Check that every file contains every message."""
        files = sorted(self.folder.rglob("*.mcap"))
        for path in files:
            with path.open("rb") as file:
                summary = make_reader(file).get_summary()
            assert summary is not None, path
            assert summary.statistics.message_count == COUNT, path


def drive(record: Path | None) -> None:
    """Run the first 30 s of the seven goals, as fast as possible."""
    simulation = Simulation(
        RunOptions(
            world="course", goals=SEVEN_GOALS.goals, headless=True,
            speed=float("inf"), max_time_s=SECONDS, record=record, overwrite=True,
        )
    )  # fmt: skip
    simulation.run()
    simulation.close()


def main() -> None:
    bench = Benchmark("recording", __doc__)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        bag = folder / "drive.mcap"
        bench.case(
            f"{SECONDS:g} s of the seven goals",
            {"navette": lambda: drive(None), "with --record": lambda: drive(bag)},
            "includes creation of the nodes; recording activates sensors "
            "without other subscribers",
            budget_s=4.0,
        )
        writers = Writers(folder / "written")
        writers.folder.mkdir()
        contenders: dict[str, Callable[[], object]] = {"navette": writers.with_navette}
        if rosbags is not None:
            contenders["rosbags"] = writers.with_rosbags()
        if mcap_ros2 is not None:
            contenders["mcap-ros2-support"] = writers.with_mcap_ros2()
        for run in contenders.values():
            run()
        writers.check()
        bench.case(
            "a message into a bag",
            contenders,
            "every file contains every message; rosbags does not compress",
            per_run=COUNT,
        )
        bench.main()


if __name__ == "__main__":
    main()
