"""Whether the robot counts as localized: by the match of the scan and the spread."""

from enum import StrEnum

from navette.navigation.localization.amcl.params import AmclParams

# Least weight of the heaviest cluster of a robot that is localized; below the second
# value another place is as likely.
_LEAST_SHARE, _LOST_SHARE = 0.85, 0.5
# Scans in a row that confirm a pose.
_GOOD_SCANS = 3


class LocalizationState(StrEnum):
    """Published states of a localization node."""

    NO_MAP = "no_map"
    LOCALIZING = "localizing"
    """A given pose is not confirmed yet, or the whole map is searched."""

    LOCALIZED = "localized"
    LOST = "lost"
    """The pose was known, and no longer fits what the scanner sees."""


class ConfidenceMonitor:
    """State with hysteresis: lost after a time of poor match, localized when good."""

    def __init__(self, params: AmclParams) -> None:
        self._params = params
        self.restart(is_given=False)

    def restart(self, *, is_given: bool) -> None:
        """Restart at a given pose, which scans have to confirm, or without one."""
        self.state = LocalizationState.LOCALIZING
        self._is_given = is_given
        self._poor_since_ns: int | None = None
        self._good = 0

    @property
    def is_promising(self) -> bool:
        """Whether the last scan fits: a search would disturb what scans may confirm."""
        return self._good > 0

    def doubt(self) -> None:
        """Return to localizing: several places explain what was seen."""
        self.state, self._good = LocalizationState.LOCALIZING, 0

    def update(
        self, match: float, stddev_m: float, share: float, now_ns: int
    ) -> LocalizationState:
        """Return the state.

        Args:
            match: share of the beams that end at obstacles of the map.
            stddev_m: of the position.
            share: weight of the heaviest cluster.
            now_ns: time of the scan.
        """
        params = self._params
        if self.state is LocalizationState.LOCALIZED:
            poor = (
                match < params.lost_match
                or stddev_m > params.lost_stddev_m
                or share < _LOST_SHARE
            )
            self._note(poor, now_ns)
            return self.state
        good = (
            match >= params.localized_match
            and stddev_m <= params.localized_stddev_m
            and share >= _LEAST_SHARE
        )
        self._good = self._good + 1 if good else 0
        if self._good >= _GOOD_SCANS:
            self.state, self._poor_since_ns = LocalizationState.LOCALIZED, None
        elif self._is_given:
            self._note(not good, now_ns)
        return self.state

    def _note(self, is_poor: bool, now_ns: int) -> None:
        """Count the time of poor scans; after some the robot is lost."""
        if not is_poor:
            self._poor_since_ns = None
        elif self._poor_since_ns is None:
            self._poor_since_ns = now_ns
        elif now_ns - self._poor_since_ns >= self._params.lost_time_s * 1e9:
            self.state, self._good = LocalizationState.LOST, 0
            self._is_given = False
