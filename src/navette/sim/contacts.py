# SPDX-License-Identifier: Apache-2.0
"""Contacts of the robot with obstacles."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.build import Compiled
from navette.sim.rolling import RollingTest

_GAP_NS = 250_000_000  # a repeated contact within this time belongs to the same episode

# Kinds of geoms; every pair of them has a sum of its own.
_STANDS, _BODY, _GROUND, _OBSTACLE = 0, 1, 4, 8
_IS_CONTACT = np.zeros(17, np.bool_)
_IS_CONTACT[[_BODY + _GROUND, _BODY + _OBSTACLE, _STANDS + _OBSTACLE]] = True


@dataclass(frozen=True)
class ContactEpisode:
    """A contact of the robot's link ``part`` with an obstacle.

    ``place`` is where they met first, in metres of the world.
    """

    start_ns: int
    end_ns: int
    part: str
    obstacle: str
    place: tuple[float, float, float]


class Touch(NamedTuple):
    """The newest contact of a geom of the robot with another one, and its points."""

    geom: int
    places: list[tuple[float, float, float]]
    now_ns: int


class ContactMonitor:
    """Collects contacts of the robot with obstacles.

    Wheels, casters and other parts that reach the ground may touch the ground, and roll
    on obstacles.
    """

    def __init__(self, compiled: Compiled, rolling: RollingTest) -> None:
        self._owner = compiled.geom_owner
        self._robot = compiled.is_robot
        self._rolling = rolling
        part = np.where(rolling.stands, _STANDS, _BODY)
        other = np.where(compiled.is_ground, _GROUND, _OBSTACLE)
        self._kind = np.where(compiled.is_robot, part, other)
        self.episodes: list[ContactEpisode] = []
        # The newest pairs of geoms without a contact that can count.
        self._harmless = b""
        self._open: dict[str, int] = {}  # obstacle → index of its newest episode
        self._touches: dict[tuple[int, int], Touch] = {}  # by the pair of geoms

    @property
    def count(self) -> int:
        return len(self.episodes)

    def reset(self) -> None:
        self.episodes.clear()
        self._open.clear()
        self._touches.clear()

    @property
    def touches(self) -> Iterable[Touch]:
        """The newest contact of each pair of geoms that ever touched."""
        return self._touches.values()

    def observe(self, data: mujoco.MjData, now_ns: int) -> bool:
        """Record the contacts of the last physics step; return whether one exists."""
        pairs = data.contact.geom
        # Mostly the wheels on the ground, as in the step before.
        key = pairs.tobytes()
        if key == self._harmless:
            return False
        kind = self._kind[pairs]
        bad = _IS_CONTACT[kind[:, 0] + kind[:, 1]]
        if not bad.any():
            self._harmless = key
            return False
        bad &= ~self._rolls(data)
        for pair, (x, y, z) in zip(pairs[bad], data.contact.pos[bad], strict=True):
            mine, other = pair if self._robot[pair[0]] else pair[::-1]
            place = (float(x), float(y), float(z))
            self._note(self._owner[mine], self._owner[other], place, now_ns)
            touch = self._touches.get((int(mine), int(other)))
            if touch is None or touch.now_ns != now_ns:
                touch = Touch(int(mine), [], now_ns)
                self._touches[int(mine), int(other)] = touch
            touch.places.append(place)
        return bool(bad.any())

    def _rolls(self, data: mujoco.MjData) -> NDArray[np.bool_]:
        """Return which contacts are those of a wheel that rolls on an obstacle."""
        first, second = data.contact.geom.T
        is_first = self._robot[first]
        up = data.contact.frame[:, 2]  # of the normal, from the first to the second
        return self._rolling.rolls(
            np.where(is_first, first, second),
            np.where(is_first, second, first),
            np.where(is_first, -up, up),
            data.contact.dist,
        )

    def _note(
        self, part: str, obstacle: str, place: tuple[float, float, float], now_ns: int
    ) -> None:
        index = self._open.get(obstacle)
        if index is not None and now_ns - self.episodes[index].end_ns <= _GAP_NS:
            self.episodes[index] = replace(self.episodes[index], end_ns=now_ns)
            return
        self._open[obstacle] = len(self.episodes)
        self.episodes.append(ContactEpisode(now_ns, now_ns, part, obstacle, place))
