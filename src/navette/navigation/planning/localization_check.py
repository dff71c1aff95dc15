"""Whether the pose of the robot is known: from the status of a localization node."""

from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.reports import Phase

# After localization: the corrected pose and map follow on other topics.
_RELOCATION_NS = 500_000_000
# Status of a localization node → why the goal waits; of any other: it is localizing.
_UNLOCATED: dict[str, Outcome | Phase | None] = {
    "localized": None,
    "lost": Outcome.LOST,
}


class LocalizationCheck:
    """Why the pose is not known; without a localization node it is known."""

    def __init__(self) -> None:
        self.unlocated: Outcome | Phase | None = None
        self._relocated_ns: int | None = None

    def receive(self, status: str, now_ns: int) -> bool:
        """Store the status; return whether the pose was known, or lost, until now."""
        before, found = self.unlocated, _UNLOCATED.get(status, Phase.LOCALIZING)
        if found is None and before is not None:
            if self._relocated_ns is None:
                self._relocated_ns = now_ns + _RELOCATION_NS
            return False
        self.unlocated, self._relocated_ns = found, None
        return found is not before

    def update(self, now_ns: int) -> None:
        """Count the pose as known some time after it was found again."""
        if self._relocated_ns is not None and now_ns >= self._relocated_ns:
            self.unlocated = self._relocated_ns = None
