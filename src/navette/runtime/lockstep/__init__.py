"""Lock-step between processes: time that waits for the others; deterministic."""

from navette.runtime.lockstep.choice import clock_of_environment
from navette.runtime.lockstep.clock import LockStepClock
from navette.runtime.lockstep.conductor import Conductor
from navette.runtime.lockstep.follower import Follower

__all__ = [
    "Conductor",
    "Follower",
    "LockStepClock",
    "clock_of_environment",
]
