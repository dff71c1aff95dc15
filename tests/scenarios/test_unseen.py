"""What no sensor sees: posts behind a parked robot, boxes below the lidar's plane."""

import pytest

from navette.geometry import Pose2
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.navigation.stack.simulation import Simulation
from navette.sim import World

from .conftest import MakeSimulation

SECOND = 1_000_000_000
NOSE_M = {"jackal": 0.254, "husky": 0.495}
POST_M = 0.03
HANDS_WIDTH_M = 0.1


def parked(
    simulate: MakeSimulation,
    robot: str,
    ahead_m: float,
    behind_m: float,
    method: str,
    yaw: float,
) -> Simulation:
    """A robot nose-in at a wall, with a post behind it and a goal beyond the post."""
    nose = NOSE_M[robot]
    facing = Pose2(0.0, 0.0, yaw)
    wall = facing @ Pose2(nose + ahead_m + 0.1, 0.0, 0.0)
    post = facing @ Pose2(-nose - behind_m - POST_M, 0.0, 0.0)
    goal = facing @ Pose2(-4.0, 0.0, 0.0)
    world = World("parked").add_walls((16.0, 16.0))
    world.add_box((wall.x, wall.y), (0.2, 4.0), yaw=yaw)
    world.add_cylinder((post.x, post.y), POST_M)
    return simulate(
        world.scene(),
        robot=robot,
        start=facing,
        goals=((goal.x, goal.y),),
        parameters={"control": {"method": method}},
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robot", "ahead_m", "behind_m", "method", "yaw"),
    [
        ("husky", 0.06, 0.2, "pure_pursuit", 0.0),
        ("husky", 0.09, 0.15, "cross_track_pid", -0.4),
        ("jackal", 0.06, 0.15, "mppi", 0.0),
        ("jackal", 0.1, 0.12, "pure_pursuit", 1.1),
    ],
)
def test_a_parked_robot_does_not_touch_what_it_has_not_seen(
    simulate: MakeSimulation,
    robot: str,
    ahead_m: float,
    behind_m: float,
    method: str,
    yaw: float,
) -> None:
    simulation = parked(simulate, robot, ahead_m, behind_m, method, yaw)
    simulation.executor.spin_until(6 * SECOND)
    simulator = simulation.sim.simulator
    assert simulator.contacts.count == 0
    assert simulator.min_clearance.distance > 0.005


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robot", "height", "method"),
    [("husky", 0.25, "pure_pursuit"), ("jackal", 0.2, "mppi")],
)
def test_a_robot_that_pushes_stalls_and_drives_around(
    simulate: MakeSimulation, robot: str, height: float, method: str
) -> None:
    world = World("low box").add_walls((16.0, 16.0))
    world.add_box((2.0, 0.0), (0.3, 0.6), height=height)
    simulation = simulate(
        world.scene(),
        robot=robot,
        goals=((4.0, 0.0),),
        parameters={"control": {"method": method}},
        max_time_s=60.0,
    )
    states: list[tuple[int, str]] = []
    touched_ns: list[int] = []

    def note(msg: DiagnosticStatus) -> None:
        now_ns = simulation.context.clock.now_ns
        states.append((now_ns, msg.message))

    def watch() -> None:
        if simulation.sim.simulator.contacts.count and not touched_ns:
            touched_ns.append(simulation.context.clock.now_ns)

    monitor = simulation.monitor
    monitor.create_subscription(DiagnosticStatus, "/control/status", note, 10)
    monitor.create_timer(0.01, watch)
    simulation.run()
    stalled_ns = next(stamp for stamp, state in states if state == "stalled")
    assert touched_ns[0] < stalled_ns <= touched_ns[0] + SECOND // 2
    assert [goal.result for goal in simulation.summary().goals] == ["reached"]
