"""SLAM in a whole run: outcomes of what goes wrong, and the map of a large office."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from bench_office import NOISE, WITHIN_M

from navette.geometry import Pose2, Transform3
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.navigation.worlds.large_office import lethal_cells_near, make_large_office

from .test_amcl import START, blind, carry, drive, jump

pytestmark = pytest.mark.long


@pytest.mark.parametrize("change", [None, jump, blind], ids=["none", "jump", "blind"])
def test_disturbances_are_corrected(
    tmp_path: Path, change: Callable[[Simulation], None] | None
) -> None:
    found = drive(tmp_path, change, localization="slam")
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.final_m < 0.15


def carry_and_return(simulation: Simulation) -> None:
    """Put the robot into a room that is not mapped, and back after five seconds."""
    carry(Pose2(2.0, 2.5, -2.0))(simulation)

    def back() -> None:
        timer.cancel()
        simulation.sim.simulator.state.place(Transform3.from_pose2(START, z=0.07))

    timer = simulation.monitor.create_timer(5.0, back)


def test_a_carried_robot_is_lost_until_it_is_back(tmp_path: Path) -> None:
    found = drive(tmp_path, carry_and_return, at_s=2.0, localization="slam")
    assert "lost" in found.localization
    assert "lost" in found.planner
    assert found.localization[-1] == "localized"
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.final_m < 0.15


def test_a_room_that_looks_like_the_mapped_one_is_not_claimed(tmp_path: Path) -> None:
    """The other room is this one turned by 180°, except for its furniture."""
    found = drive(tmp_path, carry(Pose2(4.5, -3.0, 1.0)), localization="slam")
    assert found.localization == ["localized", "lost"]
    assert (found.result, found.contacts) != ("reached", 0)
    assert found.contacts == 0


def test_the_map_of_an_office_with_loops_is_exact() -> None:
    office = make_large_office(1, seed=2)
    options = RunOptions(
        world="empty",
        robot="jackal",
        start=office.start,
        goals=office.tour,
        headless=True,
        speed=math.inf,
        methods={"localization": "slam"},
        parameters={"sim": NOISE},
        max_time_s=60.0,
    )
    simulation = Simulation(options, scene=office.scene)
    try:
        simulation.run()
        summary, memory = simulation.summary(), simulation.stack.map_memory._memory
        assert [goal.result for goal in summary.goals] == ["reached"] * 5
        assert summary.contacts == 0
        near = lethal_cells_near(office, memory.occupancy(), memory.spec, WITHIN_M)
        assert near >= 0.98
        assert summary.pose_error_m.final is not None
        assert summary.pose_error_m.final < 0.15
    finally:
        simulation.close()
