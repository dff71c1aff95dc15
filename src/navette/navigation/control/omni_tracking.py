"""Track a path with an omnidirectional drive: move to the carrot, turn to its heading.

Translation and rotation are independent: the velocity points to a carrot on the path,
and the turn rate reduces the difference to the heading of the path there.
"""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from navette.geometry import angle_difference
from navette.navigation.control.command_follower import DriveState
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.params import ControlParams

_BRAKE_SHARE = 0.5  # of the deceleration, planned for the end of the path
_TURN_GAIN = 2.0  # turn rate (rad/s) per heading error (rad)
_LEAST_SHARE = 0.1  # of the speed, while the heading is wrong


@CONTROLLERS.register("omni_tracking")
@dataclass(frozen=True)
class OmniTracking:
    """Holonomic carrot tracking within the speeds of the drive."""

    Params = ControlParams
    end_heading_tolerance_rad: ClassVar[float] = 0.08
    params: ControlParams

    def command(
        self,
        state: DriveState,
        path: NDArray[np.float64],
        obstacles: NDArray[np.float64],
    ) -> tuple[float, float, float]:
        """Return the speed (m/s), the turn rate (rad/s) and the speed to the left."""
        params = self.params
        lengths = np.hypot(*np.diff(path[:, :2], axis=0).T)
        measure = np.concatenate([[0.0], np.cumsum(lengths)])
        lookahead = params.lookahead_min_m
        carrot = path[min(int(np.searchsorted(measure, lookahead)), len(path) - 1)]
        error = angle_difference(float(carrot[2]), state.yaw)
        dx, dy = float(carrot[0]) - state.x, float(carrot[1]) - state.y
        left = math.hypot(dx, dy) + max(0.0, float(measure[-1]) - lookahead)
        # On a path with bends, the body must have turned when it arrives there.
        aligned = max(_LEAST_SHARE, math.cos(min(abs(error), math.pi / 2)))
        speed = aligned * min(
            params.cruise_speed_mps,
            math.sqrt(2 * _BRAKE_SHARE * params.deceleration_mps2 * left),
        )
        forward, side = self._towards(math.atan2(dy, dx) - state.yaw, speed)
        most = params.max_turn_rate_radps
        return forward, min(most, max(-most, _TURN_GAIN * error)), side

    def _towards(self, bearing: float, speed: float) -> tuple[float, float]:
        """Return the speeds forward and to the left, scaled to the limit sideways."""
        forward, side = speed * math.cos(bearing), speed * math.sin(bearing)
        most = self.params.max_side_speed_mps
        share = min(1.0, most / abs(side)) if side else 1.0
        return forward * share, side * share
