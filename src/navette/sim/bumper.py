# SPDX-License-Identifier: Apache-2.0
"""A bumper: a switch that contacts close."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.sim.instant import Instant
from navette.sim.mount import Mount
from navette.sim.sensor_specs import ContactSensor

_HOLD_NS = 100_000_000  # a switch bounces: it counts as closed for so long


@dataclass(frozen=True)
class BumperState:
    stamp_ns: int
    is_pressed: bool


class Bumper:
    """Pressed while one of its collisions touches an obstacle within its bearings.

    ``geoms``: MuJoCo's geoms of the collisions.
    """

    def __init__(
        self, sensor: ContactSensor, mount: Mount, geoms: NDArray[np.int64]
    ) -> None:
        self.sensor = sensor
        self.mount = mount
        self._geoms = frozenset(geoms.tolist())

    def read(self, instant: Instant, rng: np.random.Generator) -> BumperState:
        """Return whether the switch is closed."""
        since_ns = instant.stamp_ns - _HOLD_NS
        pressed = any(
            touch.now_ns >= since_ns
            and touch.geom in self._geoms
            and any(self._covers(place, instant) for place in touch.places)
            for touch in instant.contacts.touches
        )
        return BumperState(instant.stamp_ns, pressed)

    def _covers(self, place: tuple[float, float, float], instant: Instant) -> bool:
        body = self.mount.body
        world_R_link = instant.data.xmat[body].reshape(3, 3)
        x, y, _ = world_R_link.T @ (np.array(place) - instant.data.xpos[body])
        x, y = x - self.sensor.centre[0], y - self.sensor.centre[1]
        low, high = self.sensor.bearings
        turn = (math.atan2(y, x) - low) % math.tau
        return turn <= high - low
