"""Result of planning: a path, or the reason why there is none."""

import math
from dataclasses import dataclass, field

import numpy as np

from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import Poses, path_cost
from navette.navigation.planning.planning_grid import PlanningGrid


@dataclass(frozen=True)
class Plan:
    """Result of planning.

    Attributes:
        outcome: named result.
        poses: (N, 3) x, y, yaw in the map frame; empty without a path.
        cost: cost of the path in metres of free driving forward.
        margin_m: clearance that the path keeps.
        expansions: poses expanded by the search with headings; 0 = not used.
        cells: number of cells that A* expanded.
        fault: error of a user's method; empty without one.
    """

    outcome: Outcome
    poses: Poses = field(default_factory=lambda: np.empty((0, 3)))
    cost: float = math.inf
    margin_m: float = math.nan
    expansions: int = 0
    cells: int = 0
    fault: str = ""


def cost_of(poses: Poses, grid: PlanningGrid, params: PlannerParams) -> float:
    """Return the cost of poses on a grid; see :func:`.path_shape.path_cost`."""
    return path_cost(
        poses,
        grid,
        turn_cost_m_per_rad=params.turn_cost_m_per_rad,
        reverse_factor=params.reverse_factor,
    )
