"""A step of 0.1 s of a Gymnasium environment: lidar navigation among 100 posts, and
other environments in their own worlds.

``navette`` steps rigid-body physics at 2 ms, as ``navette sim``; ir-sim moves a disc
by kinematics in the same world, with the same number of beams; highway-env (kinematic
cars, lidar of 64 cells) is the nearest other that pip installs.
"""

import os
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from bench_lidar import POST_RADIUS_M, irsim_world, posts
from harness import Benchmark, Figure, optional

import navette.navigation.gym  # noqa: F401 - registers the environment
from navette.sim import Scene, World

os.environ.setdefault("MPLBACKEND", "Agg")
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
irsim: Any = optional("irsim")
highway: Any = optional("highway_env")

ID = "navette/Navigation-v0"
BEAMS = 720
STEPS = 20
RUNS = 30


def scene() -> Scene:
    world = World("posts")
    for x, y in posts():
        world.add_cylinder((x, y), POST_RADIUS_M)
    return world.scene()


def navette_env(
    world: Any = None, robot: str = "jackal", **sim: float
) -> gymnasium.Env[Any, Any]:
    return gymnasium.make(
        ID, world=world or scene(), robot=robot, parameters={"sim": sim}
    )


def stepping(env: gymnasium.Env[Any, Any], scale: float = 0.3) -> Callable[[], None]:
    """Return a run of some steps with random actions; ended episodes begin again."""
    env.reset(seed=0)
    env.action_space.seed(0)

    def run() -> None:
        for _ in range(STEPS):
            action = env.action_space.sample()
            if isinstance(env.action_space, gymnasium.spaces.Box):
                action = (scale * action).astype(env.action_space.dtype)
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

    return run


def irsim_stepping() -> Callable[[], None]:
    """Drive ir-sim's robot in the same world; it senses in each step."""
    angles = np.linspace(-2.356, 2.356, BEAMS)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "world.yaml"
        path.write_text(irsim_world(0.0, 0.0, angles).replace(
            "world: {", "world: {step_time: 0.1, "
        ))  # fmt: skip
        env = irsim.make(str(path), disable_all_plot=True, log_level="ERROR")
    rng = np.random.default_rng(0)

    def run() -> None:
        for _ in range(STEPS):
            env.step(rng.uniform(-0.3, 0.3, (2, 1)))
            assert len(env.robot.lidar.range_data) == BEAMS
            if env.done():
                env.reset()

    return run


def others() -> dict[str, Callable[[], None]]:
    """Other packages' environments in their own worlds."""
    found: dict[str, Callable[[], None]] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about versions of their own
        if highway is not None:
            lidar = {"observation": {"type": "LidarObservation", "cells": 64}}
            env = gymnasium.make("highway-fast-v0", config=lidar)
            found["highway-env"] = stepping(env)
    return found


def rate(name: str, env: gymnasium.Env[Any, Any]) -> Callable[[], Figure]:
    """Measure steps per second of CPU time, which other programs do not slow much."""

    def measure() -> Figure:
        run = stepping(env)
        run()
        begin = time.process_time()
        for _ in range(RUNS):
            run()
        elapsed_s = time.process_time() - begin
        per_s = round(RUNS * STEPS / elapsed_s)
        return Figure(f"steps per second of CPU, {name}", per_s, "/s")

    return measure


def main() -> None:
    bench = Benchmark("gymnasium", __doc__, budget_s=4.0)
    contenders = {
        "navette": stepping(navette_env()),
        "navette, 2 ms physics": stepping(navette_env(timestep_s=0.002)),
    }
    if irsim is not None:
        contenders["ir-sim"] = irsim_stepping()
    bench.case(f"100 posts, {BEAMS} beams", contenders, per_run=STEPS)
    own = {"navette": stepping(navette_env("rooms:3")), **others()}
    bench.case("each in its own world", own, per_run=STEPS)
    bench.figure(rate("Jackal among posts", navette_env()))
    bench.figure(rate("Jackal, 2 ms physics", navette_env(timestep_s=0.002)))
    bench.figure(rate("Burger in rooms", navette_env("rooms:3", "turtlebot3_burger")))
    bench.main()


if __name__ == "__main__":
    main()
