"""Lock-step between processes: virtual time that waits for all of them."""

from navette.runtime.lockstep.choice import clock_of_environment
from navette.runtime.lockstep.clock import LockStepClock
from navette.runtime.lockstep.coordinator import Coordinator
from navette.runtime.lockstep.participant import Participant

__all__ = [
    "Coordinator",
    "LockStepClock",
    "Participant",
    "clock_of_environment",
]
