"""Ackermann and omnidirectional drives in cluttered and in narrow places."""

import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.navigation.stack.simulation import Simulation
from navette.ros2.packages.nav2_simple_commander import BasicNavigator, TaskResult
from navette.sim import Scene, World

from .conftest import MakeSimulation

pytestmark = pytest.mark.long

RACECAR_CURVATURE = math.tan(0.41) / 0.3302


@dataclass
class Drive:
    """Goals with headings, one after another, and the motion on the way.

    ``motions`` has forward speed, speed to the left and turn rate every 0.1 s.
    """

    simulation: Simulation
    motions: list[tuple[float, float, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._navigator = BasicNavigator(context=self.simulation.context)

    def to(self, goal: Pose2, limit_s: float = 90.0) -> None:
        """Drive to a goal; it must be reached without contact."""
        assert self._navigator.goToPose(stamped(goal))
        simulator = self.simulation.sim.simulator
        for _ in range(round(limit_s / 0.1)):
            if self._navigator.isTaskComplete():
                break
            motion = simulator.motion()
            forward, side, _ = motion.linear
            self.motions.append((forward, side, motion.angular[2]))
        assert self._navigator.getResult() is TaskResult.SUCCEEDED
        assert simulator.contacts.count == 0
        here = simulator.pose().to_pose2()
        assert math.dist(here[:2], goal[:2]) < 0.5
        assert abs(math.remainder(here.yaw - goal.yaw, math.tau)) < 0.3

    @property
    def motion(self) -> NDArray[np.float64]:
        return np.array(self.motions)


def stamped(pose: Pose2) -> PoseStamped:
    msg = PoseStamped()
    msg.header.frame_id = "map"
    msg.pose.position.x, msg.pose.position.y = pose.x, pose.y
    msg.pose.orientation.z = math.sin(pose.yaw / 2)
    msg.pose.orientation.w = math.cos(pose.yaw / 2)
    return msg


def clutter() -> Scene:
    """A room of 12 m with boxes and posts."""
    world = World("clutter").add_walls((12.0, 12.0))
    for x, y in ((0, 0), (2, 2.5), (-2, 2), (2.2, -2), (-2.5, -2.2), (0.3, 4), (0, -4)):
        world.add_box((x, y), (0.6, 0.4), yaw=0.7 * x + y)
    for x, y in ((1, 1), (-1, 3.2), (3.8, 0.4), (-4, 0.2), (-0.8, -1.6), (1.2, -3.4)):
        world.add_cylinder((x, y), 0.1)
    return world.scene()


CLUTTERED_GOALS = (
    Pose2(4.0, 4.0, 1.57),
    Pose2(-4.0, 3.5, 3.14),
    Pose2(-3.8, -4.0, 0.0),
    Pose2(4.0, -3.8, -0.8),
)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["mppi", "pure_pursuit"])
def test_a_racecar_reaches_headings_in_clutter_within_its_curvature(
    simulate: MakeSimulation, method: str
) -> None:
    drive = Drive(
        simulate(
            clutter(),
            robot="racecar",
            start=Pose2(-5.0, -0.8, 0.0),
            parameters={"control": {"method": method}},
        )
    )
    for goal in CLUTTERED_GOALS:
        drive.to(goal)
    forward, _, turn_rate = drive.motion.T
    rolls = np.abs(forward) > 0.2
    # Tyres slip slightly in bends.
    assert np.all(np.abs(turn_rate / forward)[rolls] <= 1.05 * RACECAR_CURVATURE)
    assert np.all(np.abs(turn_rate)[~rolls] < 0.35), "it does not turn in place"


@pytest.mark.slow
def test_a_racecar_parks_in_reverse(simulate: MakeSimulation) -> None:
    """The bay is 0.6 m wide; the goal looks out of it, as a car parked in reverse."""
    world = World("car park").add_walls((10.0, 6.0))
    for x in (-0.45, 0.45):
        world.add_box((x, -1.5), (0.3, 1.0))
    world.add_box((0.0, -2.1), (1.2, 0.2))
    drive = Drive(simulate(world.scene(), robot="racecar", start=Pose2(-3.0, 0.3, 0.0)))
    drive.to(Pose2(0.0, -1.6, math.pi / 2))
    assert drive.simulation.sim.simulator.pose().to_pose2().y < -1.2, "in the bay"
    forward = drive.motion[:, 0]
    assert forward.min() < -0.2, "it enters in reverse"


@pytest.mark.slow
@pytest.mark.parametrize("method", ["mppi", "omni_tracking"])
def test_a_mecanum_platform_reaches_headings_in_clutter(
    simulate: MakeSimulation, method: str
) -> None:
    drive = Drive(
        simulate(
            clutter(),
            robot="mecanum",
            start=Pose2(-5.0, -0.8, 0.0),
            parameters={"control": {"method": method}},
        )
    )
    for goal in CLUTTERED_GOALS:
        drive.to(goal)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["mppi", "omni_tracking"])
def test_a_mecanum_platform_moves_sideways_where_it_cannot_turn(
    simulate: MakeSimulation, method: str
) -> None:
    """The body is 0.5 x 0.4 m, its diagonal 0.64 m; corridor 0.6 m, branch 0.72 m."""
    world = World("corridor").add_walls((8.0, 6.0))
    world.add_box((0.0, -1.4), (7.8, 2.2))
    world.add_box((-2.11, 1.45), (3.5, 2.3))
    world.add_box((2.11, 1.45), (3.5, 2.3))
    start = Pose2(0.0, 0.0, 0.0)
    drive = Drive(
        simulate(
            world.scene(),
            robot="mecanum",
            start=start,
            parameters={"control": {"method": method}},
        )
    )
    drive.to(Pose2(0.0, 1.7, 0.0))
    drive.to(start)
    assert np.abs(drive.motion[:, 1]).max() > 0.15
    assert np.abs(np.cumsum(drive.motion[:, 2]) * 0.1).max() < 0.4
