"""Parameters of the reflex to a contact."""

from dataclasses import dataclass

from navette.navigation.shared_params import FrameParams
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class ReflexParams(FrameParams):
    """How the robot moves away from what its bumper touched."""

    backoff_m: float = param(
        0.25, "distance driven away from the contact", at_least=0.0, at_most=2.0
    )
    speed_mps: float = param(0.15, "speed of backing off", above=0.0, at_most=1.0)
    stop_s: float = param(
        0.3, "how long the robot stays stopped before and after", at_least=0.0
    )
    rate_hz: float = param(20.0, "commands per second", at_least=5.0, at_most=100.0)
