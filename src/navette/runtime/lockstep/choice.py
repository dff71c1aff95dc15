"""Which clock a context has where its maker does not say."""

import os

from navette.errors import InvalidValueError
from navette.runtime.clock import ContextClock, SystemClock

VARIABLE = "NAVETTE_LOCKSTEP"
FOLLOW = "follow"


def clock_of_environment() -> ContextClock:
    """The system's clock; a follower where ``NAVETTE_LOCKSTEP`` is ``follow``.

    Raises:
        InvalidValueError: the variable says something else.
    """
    wanted = os.environ.get(VARIABLE, "")
    if not wanted:
        return SystemClock()
    if wanted != FOLLOW:
        raise InvalidValueError(f"{VARIABLE} {wanted!r}; known: {FOLLOW}")
    from navette.runtime.lockstep.follower import Follower

    return Follower()
