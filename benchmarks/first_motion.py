"""Start what ``navette demo`` starts, and exit as soon as the robot moves.

Run in its own process by bench_startup.py; prints the seconds from the start of the
interpreter's work to the first motion, what they went into, and the time of day then.
"""

import json
import math
import socket
import time

from navette.cli.gc_tuning import collect, uncollected

BEGIN = time.perf_counter()
MOVES_MPS = 0.05


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def main() -> None:
    with uncollected():  # as the command line
        run()


def run() -> None:
    from navette.msgs.nav_msgs.msg import Odometry
    from navette.navigation.stack import RunOptions, demo_goals
    from navette.navigation.stack.simulation import Simulation
    from navette.runtime import Node

    imported = time.perf_counter()
    options = RunOptions(
        world="arena", goals=demo_goals(), speed=1.0, port=free_port(), max_time_s=60
    )
    simulation = Simulation(options)
    created = time.perf_counter()
    watcher = Node("watcher", context=simulation.context)

    def stop_when_moving(message: Odometry) -> None:
        v = message.twist.twist.linear
        if math.hypot(v.x, v.y) > MOVES_MPS:
            simulation.stop()

    watcher.create_subscription(Odometry, "/ground_truth", stop_when_moving, 10)
    simulation.executor.add_node(watcher)
    collect()
    simulation.run()
    moving, moved_at = time.perf_counter(), time.time()
    assert simulation.context.clock.now_ns < 60e9, "never moved"
    simulation.close()
    parts = {"imports": imported, "nodes": created, "first motion": moving}
    seconds = {name: end - BEGIN for name, end in parts.items()}
    print(json.dumps({**seconds, "moved at": moved_at}))


if __name__ == "__main__":
    main()
