"""The recovery ladder of the default tree, with wheels that do not turn at first."""

import math
from pathlib import Path

import pytest

from navette.msgs.nav2_msgs.msg import BehaviorTreeLog
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.stack.simulation import Simulation
from navette.sim import World

from .conftest import MakeSimulation

SECOND = 1_000_000_000


def hold_wheels(simulation: Simulation, until_s: float) -> None:
    """Stop the wheels although they are commanded, as a motor without power does."""
    simulator, clock = simulation.sim.simulator, simulation.context.clock
    drive = simulator.command

    def command(linear: float, angular: float, side: float = 0.0) -> bool:
        held = clock.now_ns < until_s * SECOND
        return drive(0.0, 0.0) if held else drive(linear, angular, side)

    simulator.command = command  # type: ignore[method-assign]


def started(simulation: Simulation) -> list[str]:
    """Names of the tree's leaves in the order in which they started to run."""
    names: list[str] = []

    def note(msg: BehaviorTreeLog) -> None:
        names.extend(
            event.node_name
            for event in msg.event_log
            if event.current_status == "RUNNING" and event.node_name in LEAVES
        )

    simulation.monitor.create_subscription(
        BehaviorTreeLog, "/behavior_tree_log", note, 10
    )
    return names


LEAVES = {
    "Navigate",
    "ClearCostmapAroundRobot",
    "BackUpAlongPath",
    "Spin",
    "Wait",
    "BackUp",
    "AvoidPlace",
}


def held_robot(
    simulate: MakeSimulation, impatient: Path, *, until_s: float
) -> Simulation:
    """Return a Jackal in a room with a goal, whose wheels do not turn for a while."""
    simulation = simulate(
        scene=World("room").add_walls((10.0, 10.0)).scene(),
        robot="jackal",
        goals=((-3.0, 0.0),),
        params_files=(impatient,),
        max_time_s=max(60.0, until_s),
    )
    hold_wheels(simulation, until_s=until_s)
    return simulation


@pytest.mark.slow
def test_a_stuck_robot_recovers_and_arrives(
    simulate: MakeSimulation, impatient: Path
) -> None:
    simulation = held_robot(simulate, impatient, until_s=9.0)
    names = started(simulation)
    simulation.run()
    (outcome,) = simulation.summary().goals
    assert outcome.result == "reached"
    clear = "ClearCostmapAroundRobot"
    assert names[:5] == ["Navigate", clear, clear, "Navigate", "Spin"]
    assert simulation.summary().contacts == 0


@pytest.mark.slow
def test_a_robot_that_never_moves_gives_up_with_the_reason(
    simulate: MakeSimulation, impatient: Path
) -> None:
    simulation = held_robot(simulate, impatient, until_s=120.0)
    names = started(simulation)
    simulation.run()
    (outcome,) = simulation.summary().goals
    assert outcome.result == "stuck"
    assert outcome.time_s < 100.0
    assert names.count("Navigate") == 6
    assert {"Spin", "Wait", "AvoidPlace"} <= set(names)


@pytest.mark.slow
def test_a_robot_whose_nose_is_stuck_backs_up_along_its_path_and_arrives(
    simulate: MakeSimulation, impatient: Path
) -> None:
    room = World("room").add_walls((10.0, 10.0))
    room.add_box((1.6, 0.0), (0.3, 0.7), height=0.2)  # below the plane of the lidar
    simulation = simulate(
        scene=room.scene(),
        robot="jackal",
        goals=((3.5, 0.0),),
        params_files=(impatient,),
        max_time_s=90.0,
    )
    names = started(simulation)
    positions: list[tuple[str, float]] = []
    simulation.monitor.create_subscription(
        Odometry,
        "/ground_truth",
        lambda msg: positions.append(
            (names[-1] if names else "", msg.pose.pose.position.x)
        ),
        10,
    )
    simulation.run()
    (outcome,) = simulation.summary().goals
    assert outcome.result == "reached"
    # The robot goes back by a metre, unless it has driven less. Control has reported
    # where it stalled, so that the next path leads around the place.
    first = [x for name, x in positions if name == "BackUpAlongPath"]
    assert first[0] - first[-1] > min(first[0], 1.0) - 0.2
    clear = "ClearCostmapAroundRobot"
    assert names == [
        "Navigate", clear, clear, "Navigate", "BackUpAlongPath", "Navigate"
    ]  # fmt: skip


@pytest.mark.slow
def test_the_last_rung_backs_up_and_plans_around_the_place(
    simulate: MakeSimulation, impatient: Path
) -> None:
    """Beyond x = 1 m the robot can only go back, until it does so the second time."""
    room = World("room").add_walls((10.0, 10.0)).scene()
    simulation = simulate(
        scene=room,
        robot="jackal",
        goals=((3.5, 0.0),),
        params_files=(impatient,),
        max_time_s=120.0,
    )
    names = started(simulation)
    positions: list[tuple[str, float, float]] = []

    def note(msg: Odometry) -> None:
        position = msg.pose.pose.position
        positions.append((names[-1] if names else "", position.x, position.y))

    simulation.monitor.create_subscription(Odometry, "/ground_truth", note, 10)
    drive = simulation.sim.simulator.command

    def command(linear: float, angular: float, side: float = 0.0) -> bool:
        held = positions and positions[-1][1] >= 1.0 and "BackUp" not in names
        if not held:
            return drive(linear, angular, side)
        goes_back = (
            linear * math.cos(simulation.sim.simulator.pose().to_pose2().yaw) < 0
        )
        return drive(linear if goes_back else 0.0, 0.0)

    simulation.sim.simulator.command = command  # type: ignore[method-assign]
    simulation.run()
    (outcome,) = simulation.summary().goals
    assert outcome.result == "reached"
    rungs = list(dict.fromkeys(names))
    assert rungs == [
        "Navigate", "ClearCostmapAroundRobot", "BackUpAlongPath", "Spin", "Wait",
        "BackUp", "AvoidPlace",
    ]  # fmt: skip
    back = [(x, y) for name, x, y in positions if name == "BackUp"]
    assert sum(map(math.dist, back, back[1:])) > 0.6, "along its curved way"
    assert math.dist(back[0], back[-1]) > 0.4
    # Around the place where it was held, 1 m ahead of the axle at most.
    last = len(names) - 1 - names[::-1].index("AvoidPlace")
    assert names[last:] == ["AvoidPlace", "Navigate"]
    beside = [abs(y) for _, x, y in positions[-len(positions) // 2 :] if 1.0 < x < 1.5]
    assert max(beside) > 0.3
    assert simulation.summary().contacts == 0
