"""The reflex to a contact: stop, back off, stop.

iRobot's Create 3 calls its own the same (``REFLEX_BUMP``). The robot moves back along
its heading, into space that it has just left; a second contact there ends the motion.
"""

import math
from dataclasses import dataclass

from navette.geometry import Pose2
from navette.navigation.behaviors.reflex.params import ReflexParams


@dataclass(frozen=True)
class Contacts:
    """Where bumpers are pressed."""

    ahead: bool = False
    behind: bool = False


NO_CONTACT = Contacts()


class BumperReflex:
    """Commands after a contact; :meth:`step` returns None while there is none.

    The reflex begins when a bumper is pressed that was not. A bumper that stays pressed
    does not repeat it.
    """

    def __init__(self, params: ReflexParams) -> None:
        self._params = params
        self.reset()

    def reset(self) -> None:
        """Forget the contacts."""
        self._pressed = NO_CONTACT
        self._began_ns: int | None = None
        self._direction = 0.0
        self._start: Pose2 | None = None
        self._ended_ns: int | None = None

    @property
    def is_active(self) -> bool:
        """Whether the robot stops or backs off."""
        return self._began_ns is not None

    def touch(self, contacts: Contacts, now_ns: int) -> bool:
        """Note which bumpers are pressed; return whether the reflex begins."""
        before, self._pressed = self._pressed, contacts
        is_new = (contacts.ahead and not before.ahead) or (
            contacts.behind and not before.behind
        )
        if not is_new:
            return False
        if self.is_active:  # touched again while backing off: stop there
            self._ended_ns = self._ended_ns or now_ns
            return False
        self._began_ns, self._ended_ns, self._start = now_ns, None, None
        self._direction = 0.0
        if contacts.ahead != contacts.behind:
            self._direction = -1.0 if contacts.ahead else 1.0
        return True

    def step(self, odom_T_base: Pose2 | None, now_ns: int) -> float | None:
        """Return the speed (m/s) to command now, or None.

        Without odometry the distance is that of the time at the speed.
        """
        if self._began_ns is None:
            return None
        params = self._params
        since_s = (now_ns - self._began_ns) / 1e9
        if since_s < params.stop_s:
            return 0.0
        self._start = self._start or odom_T_base
        if self._ended_ns is None and self._is_far(odom_T_base, since_s):
            self._ended_ns = now_ns
        if self._ended_ns is None:
            return self._direction * params.speed_mps
        if (now_ns - self._ended_ns) / 1e9 < params.stop_s:
            return 0.0
        self._began_ns = None
        return None

    def _is_far(self, odom_T_base: Pose2 | None, since_s: float) -> bool:
        """Whether the robot has backed off, or has had twice the time for it."""
        params = self._params
        if self._direction == 0.0 or params.backoff_m == 0.0:
            return True
        needed_s = params.backoff_m / params.speed_mps
        moving_s = since_s - params.stop_s
        if odom_T_base is None or self._start is None:
            return moving_s >= needed_s
        driven = math.dist(odom_T_base[:2], self._start[:2])
        return driven >= params.backoff_m or moving_s >= 2.0 * needed_s
