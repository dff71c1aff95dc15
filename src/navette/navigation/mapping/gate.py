"""Decide which costmaps are fused into the map."""

from navette.geometry import angle_difference
from navette.navigation.mapping.memory import MapMemory, PlacedCostmap
from navette.navigation.mapping.params import MapMemoryParams

# What vanishes this near an obstacle that stands does not open a way.
_BESIDE_M = 0.15


class FusionGate:
    """Decide which costmaps are fused into the map.

    - The first one with known cells: at once.
    - On arrival: if an obstacle near the robot appeared or moved away, so that a
      waiting or fast robot does not use an old map until the next timer; at most once
      per ``change_period_s``.
    - On the timer: if the robot moved or turned far enough since the last, or obstacle
      cells vanished beside an obstacle that stands: mostly single echoes. By a cell is
      far enough if the last saw through obstacles which may be gone.

    Never while the robot spins, falls or tilts: the scan is distorted, or at a height
    other than the one the robot drives at.
    """

    def __init__(self, params: MapMemoryParams) -> None:
        self.params = params
        self.reset()

    def reset(self) -> None:
        """Clear the state: no costmap was fused."""
        self._last: PlacedCostmap | None = None
        self._last_ns = 0

    def on_arrival(
        self, costmap: PlacedCostmap, memory: MapMemory, now_ns: int
    ) -> bool:
        """Return whether to fuse a costmap on arrival."""
        if self._is_unsteady(costmap):
            return False
        if self._last is None:
            return True
        if not self.params.fuse_on_change:
            return False
        if now_ns - self._last_ns < round(self.params.change_period_s * 1e9):
            return False
        few, compared = self.params.change_cells, memory.compared(costmap)
        appeared = compared.count_appeared()
        return appeared >= few or compared.count_vanished(_BESIDE_M) >= few

    def on_timer(self, newest: PlacedCostmap, memory: MapMemory) -> bool:
        """Return whether to fuse the newest costmap on the timer."""
        last = self._last
        if self._is_unsteady(newest) or last is newest:
            return False
        if last is None:
            return True
        moved = last.map_T_base.distance_to(newest.map_T_base)
        turned = abs(angle_difference(newest.map_T_base.yaw, last.map_T_base.yaw))
        is_clearing = memory.vanishing >= self.params.change_cells
        far_m = self.params.update_distance_m
        if is_clearing:
            far_m = min(far_m, self.params.resolution_m)
        if moved >= far_m or turned >= self.params.update_angle_rad:
            return True
        if not self.params.fuse_on_change:
            return False
        vanished = memory.compared(newest).count_vanished()
        return vanished >= self.params.change_cells

    def fused(self, costmap: PlacedCostmap, now_ns: int) -> None:
        """Record that ``costmap`` was fused."""
        self._last, self._last_ns = costmap, now_ns

    def _is_unsteady(self, costmap: PlacedCostmap) -> bool:
        motion, params = costmap.motion, self.params
        return (
            abs(motion.yaw_rate) > params.max_yaw_rate_radps
            or abs(motion.vertical_speed) > params.max_vertical_speed_mps
            or motion.tilt > params.max_tilt_rad
        )
