"""Record a run as an MCAP bag and read it with the ``mcap`` library.

Prints::

    profile: ros2
    /map is recorded: True
    from (-7.5, -7.5), driving after 2.00 s: True
"""

import math
import tempfile
from pathlib import Path

from mcap.reader import make_reader

from navette.msgs import deserialize
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

with tempfile.TemporaryDirectory() as folder:
    bag = Path(folder) / "run.mcap"
    options = RunOptions(
        goals=((6.2, -3.4),),
        headless=True,
        speed=math.inf,
        max_time_s=2.0,
        record=bag,
    )
    simulation = Simulation(options)
    simulation.run()
    simulation.close()

    with bag.open("rb") as stream:
        reader = make_reader(stream)
        profile = reader.get_header().profile
        topics = {c.topic for c in reader.get_summary().channels.values()}
        truth = [
            deserialize(message.data, Odometry)
            for _, _, message in reader.iter_messages(topics="/ground_truth")
        ]

print("profile:", profile)
print("/map is recorded:", "/map" in topics)
start, last = truth[0].pose.pose.position, truth[-1]
seconds = last.header.stamp.sec + last.header.stamp.nanosec / 1e9
is_driving = last.twist.twist.linear.x > 0.5
print(
    f"from ({start.x:.1f}, {start.y:.1f}), driving after {seconds:.2f} s: {is_driving}"
)
