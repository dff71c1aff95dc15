"""A trial: one robot, one world, goals and a seed; and its measured result."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from navette.geometry import Pose2

Point = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Trial:
    """What to drive, and what counts as success.

    Attributes:
        suite: name of the set of worlds.
        name: name of the trial within the suite.
        world: name of a built-in world, a file, or ``KIND:SEED`` of a generated one.
        robot: built-in name or file; None = the world's own.
        start: pose in the map; None = that of the world.
        goals: goals in the map (m), one after another.
        seed: seed of all noise.
        reach_m: distance from the last goal, by the true pose, that ends the trial as a
            success; 0 = every goal must be ``reached`` by the planner.
        ends_at_contact: whether the first contact ends the trial.
        limit_s: simulated time for the trial.
        shortest_m: length of the shortest path, for the score and the path ratio.
        fastest_mps: speed of the ideal run in BARN's score.
        parameters: node name → parameter → value, over those of the robot.
        params_files: ROS 2 parameter files, applied last.
        methods: planner, controller, costmap, mapping → name or place.
        replacements: node of the stack → the user's class of nodes.
        variant: name of what is compared; "" without a comparison.
    """

    suite: str
    name: str
    world: str
    robot: str | None = None
    start: Pose2 | None = None
    goals: tuple[Point, ...]
    seed: int = 0
    reach_m: float = 0.0
    ends_at_contact: bool = False
    limit_s: float = 100.0
    shortest_m: float = math.nan
    fastest_mps: float = 2.0
    parameters: dict[str, dict[str, Any]] = field(default_factory=dict)
    params_files: tuple[Path, ...] = ()
    methods: dict[str, str] = field(default_factory=dict)
    replacements: dict[str, str] = field(default_factory=dict)
    variant: str = ""


@dataclass(frozen=True, kw_only=True)
class TrialResult:
    """Measures of one trial; seconds are simulated.

    Attributes:
        outcome: ``reached``, ``contact``, ``timed_out``, or the planner's result.
        time_s: from the first 0.1 m of motion to the end.
        score: BARN's score, 0 … 0.5.
        path_m: length of the driven path.
        min_clearance_m: least distance of the body to an obstacle.
        pose_error_m: distance of the estimated from the true position at the end.
        worst_pose_error_m: largest such distance while the robot was localized.
        lost_s: cause → seconds lost against driving at cruise speed.
        jerk: root mean square change of the acceleration (m/s³); lower is smoother.
        track: every tenth of a second x, y (m, map), for the pictures.
        cpu_s: node → CPU seconds of its callbacks.
        sim_s: simulated seconds of the trial.
        reach_m: distance from the goal at which the trial ended.
        variant: of the trial.
    """

    suite: str
    name: str
    seed: int
    outcome: str
    time_s: float
    score: float
    contacts: int
    path_m: float
    shortest_m: float
    min_clearance_m: float | None
    lost_s: dict[str, float]
    jerk: float
    wall_s: float
    track: list[list[float]] = field(default_factory=list)
    cpu_s: dict[str, float] = field(default_factory=dict)
    sim_s: float = math.nan
    reach_m: float = 0.0
    variant: str = ""
    pose_error_m: float | None = None
    worst_pose_error_m: float | None = None

    @property
    def path_ratio(self) -> float:
        """The driven path to the shortest one that ends the trial."""
        return self.path_m / (self.shortest_m - self.reach_m)

    @property
    def succeeded(self) -> bool:
        return self.outcome == "reached"


def barn_score(
    succeeded: bool, time_s: float, shortest_m: float, fastest_mps: float = 2.0
) -> float:
    """Return the score of the BARN challenge.

    ``success · OT / clip(AT, 2 OT, 8 OT)`` with the optimal time OT = shortest path /
    2 m/s and the actual time AT (Xiao et al., "Autonomous Ground Navigation in Highly
    Constrained Spaces", 2022).
    """
    if not succeeded:
        return 0.0
    optimal_s = shortest_m / fastest_mps
    return optimal_s / min(max(time_s, 2 * optimal_s), 8 * optimal_s)
