"""The default clock of a context, from ``NAVETTE_LOCKSTEP``."""

import os

from navette.errors import InvalidValueError
from navette.runtime.clock import ContextClock, SystemClock

VARIABLE = "NAVETTE_LOCKSTEP"
FOLLOW = "follow"


def clock_of_environment() -> ContextClock:
    """Return the system's clock, or a participant's if the variable is ``follow``.

    Raises:
        InvalidValueError: the variable has another value.
    """
    value = os.environ.get(VARIABLE, "")
    if not value:
        return SystemClock()
    if value != FOLLOW:
        raise InvalidValueError(f"{VARIABLE} {value!r}: expected {FOLLOW} or nothing")
    from navette.runtime.lockstep.participant import Participant

    return Participant()
