"""From the key press to the wheel command: in one process, over Zenoh, from the page.

Usage: ``python benchmarks/bench_takeover.py [TRIES [NAME…]]``

A robot drives to goals in real time. At random moments an operator's command is sent,
each with another turn rate, and the time is taken until that command arrives on
/cmd_vel. Over Zenoh it is the way there and back. ``planning`` plans through a maze of
1200 x 1200 cells in the same process all the time. There the second line is the robot's
own (simulated) time, which is stopped while a plan is computed.
"""

import json
import os
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from navette.files.runs import stay_shared
from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav2_msgs.action import ComputePathToPose
from navette.navigation.grids import GridSpec, grid_to_message
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.runtime import Context, DurabilityPolicy, Executor, Node, QoSProfile
from navette.runtime.action import ActionClient

LIMITS_MS = {"one process": 100, "zenoh": 150, "page": 100, "planning": 100}
PAGE = Path(__file__).parents[1] / "tests/conformance/js/operator.mjs"
GOALS = ((6.2, -3.4), (8.2, 7.8), (-5.0, 8.3), (-7.5, -2.0)) * 20


class Wheels:
    """Arrival of each command by its turn rate: wall time (ns) and robot time (ns)."""

    def __init__(self, node: Node) -> None:
        self.arrived: dict[float, tuple[int, int]] = {}
        self._clock = node.get_clock()
        node.create_subscription(Twist, "/cmd_vel", self._on_command, 100)

    def _on_command(self, msg: Twist) -> None:
        now = time.time_ns(), self._clock.now_ns
        self.arrived.setdefault(round(msg.angular.z, 6), now)


def report(name: str, delays_ms: list[float], tries: int) -> None:
    limit = LIMITS_MS[name.split(",")[0]]
    ordered = np.sort(delays_ms)
    within = int(np.count_nonzero(ordered <= limit))
    sys.stdout.write(
        f"{name:24} median {np.median(ordered):6.1f} ms   95 % "
        f"{np.percentile(ordered, 95):6.1f}   longest {ordered[-1]:6.1f}   "
        f"{within} of {tries} within {limit} ms\n"
    )


@contextmanager
def driving(*, headless: bool = True, goals: bool = True) -> Any:
    """A robot that drives in real time in another thread."""
    options = RunOptions(
        goals=GOALS if goals else (), headless=headless, speed=1.0, port=0
    )
    run = Simulation(options)
    pilot = Node("pilot", context=run.context)
    run.executor.add_node(pilot)
    thread = threading.Thread(target=run.run)
    thread.start()
    try:
        time.sleep(4.0)
        yield run, pilot
    finally:
        run.stop()
        thread.join()
        run.close()


def press(send: Callable[[Twist], None], tries: int) -> dict[float, int]:
    """Send commands at random moments; return the wall time of each."""
    rng = np.random.default_rng(0)
    pressed = {}
    for number in range(tries):
        twist = Twist()
        twist.angular.z = round(0.1 + 0.001 * number, 6)
        time.sleep(rng.uniform(0.02, 0.15))
        pressed[twist.angular.z] = time.time_ns()
        send(twist)
    time.sleep(2.0)
    return pressed


def delays(pressed: dict[float, int], wheels: Wheels) -> list[float]:
    return [
        (wheels.arrived[turn][0] - at_ns) / 1e6 if turn in wheels.arrived else np.inf
        for turn, at_ns in pressed.items()
    ]


def one_process(tries: int) -> None:
    with driving() as (run, pilot):
        wheels = Wheels(pilot)
        keys = pilot.create_publisher(Twist, "/cmd_vel_teleop", 10)

        def send(twist: Twist) -> None:
            run.executor.call_soon_threadsafe(lambda: keys.publish(twist))

        report("one process", delays(press(send, tries), wheels), tries)


def planning(tries: int) -> None:
    n = 1200
    cells = np.zeros((n, n), np.int8)
    for k in range(60, n, 60):
        cells[:, k : k + 3] = 100
        gap = 40 if (k // 60) % 2 else n - 90
        cells[gap : gap + 50, k : k + 3] = 0
    spec = GridSpec(0.05, n, n, Pose2(-12.0, -12.0, 0.0))
    with driving(goals=False) as (run, pilot):
        run.executor.remove_node(run.stack.map_memory)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        maps = pilot.create_publisher(type(grid_to_message(cells, spec, "map", 0)),
                                      "/map", latched)  # fmt: skip
        client = ActionClient(pilot, ComputePathToPose, "compute_path_to_pose")
        keys = pilot.create_publisher(Twist, "/cmd_vel_teleop", 10)
        wheels = Wheels(pilot)
        robot_ns: dict[float, int] = {}
        held_ms: list[float] = []

        def request() -> None:
            goal = ComputePathToPose.Goal()
            goal.goal.header.frame_id = "map"
            goal.goal.pose.position.x = goal.goal.pose.position.y = 45.0
            goal.goal.pose.orientation.w = 1.0
            begun = time.perf_counter()

            def accepted(answer: Any) -> None:
                if answer.result() is not None:  # it is at the end of the program
                    answer.result().get_result_async().add_done_callback(done)

            def done(_: object) -> None:
                held_ms.append((time.perf_counter() - begun) * 1e3)

            client.send_goal_async(goal).add_done_callback(accepted)

        run.executor.call_soon_threadsafe(
            lambda: maps.publish(grid_to_message(cells, spec, "map", 0))
        )
        pilot.create_timer(3.0, request)

        def send(twist: Twist) -> None:
            def publish() -> None:
                robot_ns[twist.angular.z] = run.context.clock.now_ns
                keys.publish(twist)

            run.executor.call_soon_threadsafe(publish)

        pressed = press(send, tries)
        report("planning", delays(pressed, wheels), tries)
        own = [
            (wheels.arrived[turn][1] - at_ns) / 1e6
            for turn, at_ns in robot_ns.items()
            if turn in wheels.arrived
        ]
        report("planning, robot's time", own, tries)
        if held_ms:
            sys.stdout.write(
                f"{len(held_ms)} plans, each of up to {max(held_ms):.0f} ms "
                f"(median {np.median(held_ms):.0f})\n"
            )


def zenoh(tries: int) -> None:
    stay_shared()  # another run of the user is not measured
    env = {**os.environ, "NAVETTE_TRANSPORT": "zenoh"}
    words = [w for x, y in GOALS[:8] for w in ("--goal", str(x), str(y))]
    robot = subprocess.Popen(
        [sys.executable, "-m", "navette", "sim", "arena", "--port", "0", "--share",
         *words],
        env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        with Context(transport="zenoh") as context:
            node = Node("pilot", context=context)
            executor = Executor(context=context)
            executor.add_node(node)
            wheels = Wheels(node)
            keys = node.create_publisher(Twist, "/cmd_vel_teleop", 10)
            threading.Thread(target=executor.spin, daemon=True).start()
            while not (keys.get_subscription_count() and wheels.arrived):
                time.sleep(0.1)
            report("zenoh", delays(press(keys.publish, tries), wheels), tries)
            executor.stop()
    finally:
        robot.terminate()
        robot.wait()


def page(tries: int) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None or shutil.which("node") is None:
        sys.stdout.write("page: Chromium or Node.js is not installed\n")
        return
    commands: list[tuple[float, float]] = []
    with driving(headless=False) as (run, pilot):
        pilot.create_subscription(
            Twist,
            "/cmd_vel",
            lambda msg: commands.append((time.time_ns() / 1e6, msg.angular.z)),
            100,
        )
        done = subprocess.run(
            ["node", str(PAGE), run.viewer.url, chromium, str(tries), "only-keys"],
            capture_output=True,
            text=True,
            check=True,
        )
    turns = {"ArrowLeft": 0.8, "ArrowRight": -0.8}
    presses = [
        (turns[k], ms) for k, ms in json.loads(done.stdout)["presses"] if k in turns
    ]
    found = [
        next((at - ms for at, z in commands if at >= ms and z == turn), np.inf)
        for turn, ms in presses
    ]
    report("page", found, tries)


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    chosen = sys.argv[2:] or ["one_process", "zenoh", "page", "planning"]
    for name in chosen:
        globals()[name](count)
