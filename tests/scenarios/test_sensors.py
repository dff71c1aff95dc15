"""What a planar lidar does not see: a table, a stairwell; and contact by bumper."""

import math

import pytest

from navette.geometry import Pose2
from navette.navigation.stack.summary import RunSummary
from navette.sim import World
from navette.sim.surface import GLASS
from scenarios.conftest import MakeSimulation

GOAL = (4.0, 0.0)


def driven(
    simulate: MakeSimulation, world: str, *sensors: str, until_s: float
) -> RunSummary:
    simulation = simulate(
        world=world, sensors=sensors, goals=(GOAL,), max_time_s=until_s
    )
    simulation.run()
    return simulation.summary()


def test_with_a_planar_lidar_alone_the_robot_touches_the_table(
    simulate: MakeSimulation,
) -> None:
    summary = driven(simulate, "table", until_s=10.0)
    assert summary.contacts > 0


@pytest.mark.long
def test_with_a_depth_camera_the_robot_drives_around_the_table(
    simulate: MakeSimulation,
) -> None:
    summary = driven(simulate, "table", "d435", until_s=40.0)
    assert [goal.result for goal in summary.goals] == ["reached"]
    assert summary.contacts == 0
    assert summary.min_clearance_m is not None
    assert summary.min_clearance_m > 0.05


@pytest.mark.long
def test_with_a_planar_lidar_alone_the_robot_tips_over_the_edge_of_the_stairwell(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate(world="stairs", goals=(GOAL,), max_time_s=9.0)
    simulation.run()
    up = simulation.sim.simulator.pose().apply((0.0, 0.0, 1.0))
    x, y, _ = simulation.sim.simulator.pose().translation
    assert math.hypot(up[0] - x, up[1] - y) > math.sin(math.radians(5.0))
    assert simulation.summary().contacts > 0


@pytest.mark.long
def test_with_a_depth_camera_the_robot_drives_around_the_stairwell(
    simulate: MakeSimulation,
) -> None:
    summary = driven(simulate, "stairs", "d435", until_s=40.0)
    assert [goal.result for goal in summary.goals] == ["reached"]
    assert summary.contacts == 0


@pytest.mark.long
def test_steps_that_lead_up_are_obstacles_for_a_depth_camera(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate(
        world="stairs",
        sensors=("d435",),
        start=Pose2(0.0, 2.4, 0.0),
        goals=((5.2, 2.4),),
        max_time_s=60.0,
    )
    simulation.run()
    summary = simulation.summary()
    assert [goal.result for goal in summary.goals] == ["reached"]
    assert summary.contacts == 0


@pytest.mark.long
def test_with_a_ring_lidar_the_robot_drives_around_the_table(
    simulate: MakeSimulation,
) -> None:
    summary = driven(simulate, "table", "vlp16", until_s=60.0)
    assert [goal.result for goal in summary.goals] == ["reached"]
    assert summary.contacts == 0


def test_after_a_contact_the_robot_backs_off_and_reaches_the_goal_another_way(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate(
        world="table", sensors=("bumper",), goals=(GOAL,), max_time_s=90.0
    )
    executor = simulation.executor
    places: list[float] = []
    contacts = simulation.sim.simulator.contacts
    while not contacts.count and simulation.context.clock.now_ns < 20 * 10**9:
        executor.spin_for(100_000_000)
    touched_at = simulation.sim.simulator.pose().translation
    for _ in range(40):
        executor.spin_for(100_000_000)
        places.append(
            math.dist(simulation.sim.simulator.pose().translation, touched_at)
        )
    assert max(places) >= 0.2  # backed off, within 4 s
    simulation.run()
    summary = simulation.summary()
    assert [goal.result for goal in summary.goals] == ["reached"]
    # Feels its way along the edge; it does not push against it.
    assert summary.contacts <= 6


@pytest.mark.long
def test_glass_is_touched_by_a_lidar_alone_and_not_with_sonars(
    simulate: MakeSimulation,
) -> None:
    """A pane across the corridor that is met at 30° from its normal."""
    world = World("pane").add_walls((14.0, 8.0))
    world.add_box((0.0, 0.0), (0.04, 3.0), yaw=0.5, surface=GLASS, height=1.0)
    outcomes = []
    for sensors in ((), ("hc_sr04", "hc_sr04@left", "hc_sr04@right")):
        simulation = simulate(
            world.scene(),
            robot="jackal",
            sensors=sensors,
            start=Pose2(-4.0, 0.0, 0.0),
            goals=((4.0, 0.0),),
            max_time_s=20.0,
        )
        simulation.run()
        outcomes.append(simulation.summary().contacts)
    assert outcomes[0] > 0
    assert outcomes[1] < outcomes[0]
