"""Create the golden bags: one drive of the simulator, cut into one bag per stage.

    python tests/replay/make_golden.py

Run it when a stage is meant to produce other results: first check the output of
`navette bag replay --compare` with the old bags, then commit the new bags with the
change.
"""

import math
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from stages import STAGES, Stage

from navette.bags import BagReader, BagWriter, open_bag, qos_text
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation

WORLD = "course"
GOALS = ((-6.0, -12.0),)
PARAMETERS = """
costmap:
  ros__parameters:
    size_m: 10.0 # small, so that the bags are small
"""
LONGEST_BYTES = 300_000


def drive(path: Path) -> None:
    """Record the drive."""
    parameters = path.with_suffix(".yaml")
    parameters.write_text(PARAMETERS)
    simulation = Simulation(
        RunOptions(
            world=WORLD,
            goals=GOALS,
            headless=True,
            speed=math.inf,
            record=path,
            params_files=(parameters,),
            max_time_s=30.0,
        )
    )
    try:
        simulation.run()
    finally:
        simulation.close()


def cut(source: BagReader, stage: Stage) -> None:
    """Write the stage's inputs and outputs to its bag, from the start."""
    writer = BagWriter(stage.bag, overwrite=True)
    numbers = {}
    end_ns = source.start_ns + round(stage.duration_s * 1e9)
    topics = "/parameter_events", *stage.inputs, *stage.outputs
    for message in source.messages(topics, end_ns=end_ns):
        topic = message.topic
        if topic not in numbers:
            numbers[topic] = writer.add_channel(
                topic.name,
                topic.type_name,
                topic.definition,
                type_hash=topic.type_hash,
                qos=qos_text(topic.qos),
            )
        writer.write(numbers[topic], message.stamp_ns, message.data)
    writer.close()


def main() -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "drive.mcap"
        drive(path)
        with open_bag(path) as source:
            for stage in STAGES:
                cut(source, stage)
                size = stage.bag.stat().st_size
                sys.stdout.write(f"{stage.bag.name}: {size} bytes\n")
                if size > LONGEST_BYTES:
                    raise SystemExit(f"{stage.bag.name} is larger than {LONGEST_BYTES}")


if __name__ == "__main__":
    main()
