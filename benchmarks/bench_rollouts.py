"""A step of the predictive controller: noise, rollouts, costs and weighted mean.

    python benchmarks/bench_rollouts.py [--json]

The robot is a Jackal among posts 0.8 m apart, so that nearly every sample needs the
clearance of its whole body. Times are of one step of the controller.
"""

from typing import Any

import numpy as np
from harness import Benchmark

from navette.geometry import Footprint
from navette.navigation.control.local_field import local_field
from navette.navigation.control.mppi import MotionState, Mppi
from navette.navigation.control.params import ControlParams
from navette.navigation.control.rollouts import PathWindow
from navette.navigation.grids import body_points

FOOTPRINT = (0.254, 0.215, -0.254, 0.215, -0.254, -0.215, 0.254, -0.215)


def scene() -> tuple[MotionState, PathWindow, Any]:
    """Return a moving robot, a bent path and posts beside it."""
    x = np.arange(0.0, 6.0, 0.1)
    y = 0.4 * np.sin(x)
    yaw = np.arctan2(0.4 * np.cos(x), 1.0)
    measure = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    path = PathWindow(x, y, np.cos(yaw), np.sin(yaw), measure, np.ones(60, np.int8))
    posts = np.column_stack([x[::8], y[::8] + 0.45])
    posts = np.concatenate([posts, posts - (0.0, 0.9)])
    return MotionState(0, 0, 0.38, 1.0, 0.0), path, local_field(posts, 0.05, 1.25)


def bench() -> Benchmark:
    benchmark = Benchmark("predictive controller", __doc__)
    state, path, field = scene()
    body = body_points(Footprint.from_flat(FOOTPRINT), 0.15)
    for samples, steps, target_ms in ((265, 28, 0.8), (1965, 56, 5.0)):
        params = ControlParams(
            method="mppi",
            mppi_samples=samples,
            mppi_steps=steps,
            mppi_step_s=2.8 / steps,
            cruise_speed_mps=2.0,
            footprint_m=FOOTPRINT,
        )
        first, second = Mppi(params, body), Mppi(params, body)
        one = [first.step(state, path, field, 0.05) for _ in range(3)]
        assert one == [second.step(state, path, field, 0.05) for _ in range(3)]

        def step(mppi: Mppi = first) -> object:
            return mppi.step(state, path, field, 0.05)

        benchmark.case(
            f"step of {samples + 35} samples of {steps} steps",
            {"navette": step},
            "the same seed gives the same commands",
            target_ms=target_ms,
        )
    return benchmark


if __name__ == "__main__":
    bench().main()
