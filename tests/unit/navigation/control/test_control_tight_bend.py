"""A bend around the end of a wall that leaves less room than steering needs."""

import numpy as np
from control_plant import Plant, run

from navette.geometry import Pose2
from navette.navigation.control import ControlParams, PathFollower

FOOTPRINT = (
    *(0.495, 0.2, 0.421, 0.335, -0.421, 0.335, -0.495, 0.2),
    *(-0.495, -0.2, -0.421, -0.335, 0.421, -0.335, 0.495, -0.2),
)
PARAMS = ControlParams(
    footprint_m=FOOTPRINT,
    cruise_speed_mps=0.8,
    reverse_speed_mps=0.4,
    max_turn_rate_radps=1.2,
    turn_acceleration_radps2=3.0,
)
# A wall of 0.1 m ends at y = -5.2; the body stands 3 cm beside its end.
WALL_END = np.array(
    [(x, -5.2) for x in np.arange(-1.775, -1.67, 0.0125)]
    + [(x, y) for x in (-1.775, -1.675) for y in np.arange(-5.2, -4.0, 0.0125)]
)
START = Pose2(-1.293, -5.312, -2.287)
PATH = np.array(
    [
        (-1.293, -5.312, -2.287),
        (-1.359, -5.387, -2.287),
        (-1.424, -5.463, -2.287),
        (-1.470, -5.512, -2.352),
        (-1.518, -5.557, -2.418),
        (-1.570, -5.600, -2.483),
        (-1.624, -5.639, -2.549),
        (-1.680, -5.674, -2.614),
        (-1.739, -5.706, -2.680),
        (-1.799, -5.734, -2.745),
        (-1.862, -5.757, -2.811),
        (-1.925, -5.777, -2.876),
    ]
)


def test_a_robot_that_steering_would_stop_drives_a_nearby_arc() -> None:
    follower = PathFollower(PARAMS)
    follower.set_obstacles(WALL_END, 0.00625)
    follower.set_path(PATH)
    result = run(follower, Plant(START, lag_s=0.05, turning=1.0), 12.0)
    assert result.final.state == "reached"
    assert min(output.clearance_m for output in result.outputs) > 0.01


def test_a_robot_before_a_wall_stays_blocked() -> None:
    ahead = START @ Pose2(0.57, 0.0, 0.0)
    across = [ahead @ Pose2(0.0, y, 0.0) for y in np.arange(-0.5, 0.51, 0.0125)]
    follower = PathFollower(PARAMS)
    follower.set_obstacles(np.array([(p.x, p.y) for p in across]), 0.00625)
    follower.set_path(PATH)
    plant = Plant(START, lag_s=0.05, turning=1.0)
    result = run(follower, plant, 4.0)
    assert result.final.state == "blocked"
    assert plant.pose.distance_to(START) < 0.05


def test_between_walls_a_robot_beside_its_path_drives_straight_on() -> None:
    along = np.arange(-1.0, 4.0, 0.0125)
    walls = [(x, y) for y in (-0.361, 0.361) for x in along]
    follower = PathFollower(PARAMS)
    follower.set_obstacles(np.array(walls), 0.00625)
    follower.set_path(np.array([(x, 0.3, 0.0) for x in np.arange(-0.2, 3.0, 0.05)]))
    plant = Plant(Pose2(0.0, 0.0, 0.0), lag_s=0.05, turning=1.0)
    result = run(follower, plant, 10.0)
    assert plant.pose.x > 1.0
    assert min(output.clearance_m for output in result.outputs) > 0.01
