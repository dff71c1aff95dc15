"""Places that plans avoid because the robot got stuck before them.

What stopped the robot may be invisible to its sensors. The place ahead of it counts as
an obstacle until the goal is reached, another goal is given, or no other path exists.
"""

import copy
import math

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import LETHAL, GridSpec
from navette.navigation.planning.path_shape import Poses

Point = tuple[float, float]
# Two goals within this distance are the same goal, sent again.
_SAME_GOAL_M = 0.3
_RADIUS_M = 0.4


class AvoidedPlaces:
    """Discs on the map, one for each place where the robot got stuck."""

    def __init__(self) -> None:
        self._candidate: Point | None = None
        self._places: list[Point] = []
        self._goal: Point | None = None

    def copy(self) -> "AvoidedPlaces":
        """Return places that change independently."""
        other = copy.copy(self)
        other._places = self._places.copy()
        return other

    def __bool__(self) -> bool:
        return bool(self._places)

    def note_goal(self, goal: Point) -> bool:
        """Note a goal; return whether places of another goal were dropped."""
        before, self._goal = self._goal, goal
        if before is not None and math.dist(before, goal) <= _SAME_GOAL_M:
            return False
        return self.clear()

    def note_stuck(self, ahead: Poses, front_m: float) -> None:
        """Note the path (N, 3) ahead of a stuck robot; its body ends at ``front_m``."""
        steps = np.hypot(*np.diff(ahead[:, :2], axis=0).T)
        metres = np.concatenate([[0.0], np.cumsum(steps)])
        index = int(np.searchsorted(metres, front_m + _RADIUS_M))
        if index < len(ahead):
            self._candidate = (float(ahead[index, 0]), float(ahead[index, 1]))

    def avoid(self) -> bool:
        """Avoid the last place where the robot got stuck; False if there is none."""
        if self._candidate is None:
            return False
        self._places.append(self._candidate)
        self._candidate = None
        return True

    def clear(self) -> bool:
        """Avoid nothing any more; return whether something was avoided."""
        had = bool(self._places)
        self._places.clear()
        self._candidate = None
        return had

    def marked(self, occupancy: NDArray[np.int8], spec: GridSpec) -> NDArray[np.int8]:
        """Return the map (H, W) with the places as obstacles."""
        if not self._places:
            return occupancy
        marked = occupancy.copy()
        reach = round(_RADIUS_M / spec.resolution)
        offsets = np.arange(-reach, reach + 1)
        rows, columns = np.meshgrid(offsets, offsets, indexing="ij")
        disc = np.argwhere(rows**2 + columns**2 <= reach**2) - reach
        for place in self._places:
            cells = disc + spec.cell_of(*place)
            inside = ((cells >= 0) & (cells < spec.shape)).all(axis=1)
            marked[tuple(cells[inside].T)] = LETHAL
        return marked
