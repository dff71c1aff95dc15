"""The kernels of a tick are loaded before the robot drives, without other effects."""

import subprocess
import sys

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.control.follower import BaseFollower
from navette.navigation.control.followers import make_follower
from navette.navigation.control.params import ControlParams
from navette.navigation.control.records import FollowerInputs

STRAIGHT = np.column_stack([np.linspace(0.0, 3.0, 61), np.zeros(61), np.zeros(61)])

LOADED_WHILE_DRIVING = """
from navette.files.kernels import KernelCache
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

simulation = Simulation(
    RunOptions(world="arena", goals=((3.0, 2.0),), headless=True, speed=float("inf"))
)
load = KernelCache.load_overload

def note(cache, *arguments):
    print(cache._function.__module__)
    return load(cache, *arguments)

KernelCache.load_overload = note
simulation.executor.spin_until(1_000_000_000)
simulation.close()
"""


def commands(follower: BaseFollower) -> list[object]:
    """Return the outputs of a few steps along a straight path beside a post."""
    follower.set_path(STRAIGHT)
    follower.set_obstacles(np.array([(1.0, 0.6)]), 0.01)
    here = FollowerInputs(Pose2(0.0, 0.0, 0.0), 0.0, 0.0)
    return [follower.step(here, 0.05) for _ in range(5)]


@pytest.mark.parametrize("method", ["mppi", "pure_pursuit"])
def test_a_trial_changes_no_command(method: str) -> None:
    params = ControlParams(method=method)
    fresh, warmed = make_follower(params), make_follower(params)
    assert isinstance(fresh, BaseFollower)
    assert isinstance(warmed, BaseFollower)
    warmed.warm_up()
    assert not warmed.has_path
    assert commands(warmed) == commands(fresh)


@pytest.mark.slow
def test_no_tick_of_control_waits_for_its_kernels() -> None:
    command = [sys.executable, "-c", LOADED_WHILE_DRIVING]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    modules = done.stdout.split()
    assert not [name for name in modules if ".planning." not in name]
