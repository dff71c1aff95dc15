"""Longest time between two commands to the wheels, in real time, with a page open.

    python benchmarks/bench_gap.py [--seconds S] [--json]

A Jackal drives through a hall of 200 m under the system clock, as on a real robot:
plans are computed in another thread while the robot drives on. Simulator, all nodes and
the live view run in one process. Chromium, without a graphics card, shows the page on
the same machine. A gap is the time between two commands at the simulated wheels, the
first of which moves the robot; nominal are 50 ms. A robot that stands at its goal gets
two zeros a second.

While Chromium starts, its processes occupy all cores: gaps of the first five seconds
are given on their own. Other programs on the machine lengthen the gaps, too. *Work* is
the CPU time of the event loop's thread between two commands: the gap on a machine with
a free core.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from typing import Any

import numpy as np
from hall import ends, hall
from harness import Benchmark, Figure
from numpy.typing import NDArray

from navette.msgs.geometry_msgs.msg import Twist
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.runtime.clock import SystemClock

SIZE_M = 200
LIMIT_MS = 100.0
BROWSER_STARTS_S = 5.0
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
SWITCHES = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--window-size=1440,900",
    "--disable-background-networking",
    "--disable-component-update",
)


def measured(seconds: float, browser: str) -> NDArray[np.float64]:
    """Drive with a page open; return (N, 3) time since the start in s, gap, work in ms.

    Gap and work are those between a command that moves the robot and the next one.
    """
    start, goal = ends(SIZE_M)
    options = RunOptions(robot="jackal", start=start, goals=(goal,), port=0)
    simulation = Simulation(options, scene=hall(SIZE_M), clock=SystemClock())
    arrived: list[tuple[float, float]] = []
    drives: list[bool] = []

    def on_command(msg: Twist) -> None:
        arrived.append((time.perf_counter(), time.thread_time()))
        drives.append(msg.linear.x != 0.0 or msg.angular.z != 0.0)

    simulation.sim.create_subscription(Twist, "/cmd_vel", on_command, 10, shared=True)
    assert simulation.viewer is not None, "not headless"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [browser, *SWITCHES, f"--user-data-dir={profile}"]
        page = subprocess.Popen(
            [*command, simulation.viewer.url],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            simulation.executor.spin_for(round(1e9 * seconds))
        finally:
            simulation.close()
            page.terminate()
            page.wait()
    times = np.array(arrived)
    since = times[:-1, :1] - times[0, 0]
    return np.hstack([since, 1e3 * np.diff(times, axis=0)])[np.array(drives[:-1])]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=150.0)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        sys.exit("bench_gap: no Chromium is installed")
    steps = measured(options.seconds, browser)
    starts = steps[:, 0] < BROWSER_STARTS_S
    _, gaps, work = steps[~starts].T
    found: dict[str, Any] = {
        "longest": gaps.max(),
        "99.9 %": np.percentile(gaps, 99.9),
        "median": np.median(gaps),
        "longest work": work.max(),
        "first 5 s": steps[starts, 1].max(),
    }
    bench = Benchmark("command gap", __doc__)
    for name, value in found.items():
        limit = LIMIT_MS if name.startswith("longest") else None
        title = f"Jackal, {SIZE_M} m, page open: {name}"
        figure = Figure(title, float(value), "ms", limit)
        bench.figure(lambda figure=figure: figure)
    bench.run()
    if options.json:
        print(json.dumps(bench.as_dict()))
    else:
        print(bench.table())


if __name__ == "__main__":
    main()
