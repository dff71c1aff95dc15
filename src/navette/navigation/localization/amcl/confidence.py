"""Whether the robot counts as localized: by the match of the scan and the spread.

A scan with too few echoes neither confirms nor contradicts the pose.
"""

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


class DoubtCause(StrEnum):
    """Reasons why a robot is not localized any more."""

    CONTRADICTED = "the scans contradict the map at the estimated pose"
    UNCERTAIN = "the position is too uncertain"
    ELSEWHERE = "the scans along the path fit another place of the map better"


class ConfidenceMonitor:
    """State with hysteresis: lost after a time of poor match, localized when good.

    Attributes:
        state: the published state.
        cause: why the robot is not localized any more; None if it is, or never was.
    """

    def __init__(self, params: AmclParams) -> None:
        self._params = params
        self.restart(is_given=False)

    def restart(self, *, is_given: bool) -> None:
        """Restart at a given pose, which scans have to confirm, or without one."""
        self.state = LocalizationState.LOCALIZING
        self.cause: DoubtCause | None = None
        self._is_given = is_given
        self._poor_since_ns: int | None = None
        self._good = 0

    @property
    def is_promising(self) -> bool:
        """Whether the last scan fits: a search would disturb what scans may confirm."""
        return self._good > 0

    def doubt(self, cause: DoubtCause | None = None) -> None:
        """Return to localizing: several places, or another one, explain the scans."""
        self.state, self._good = LocalizationState.LOCALIZING, 0
        self.cause, self._is_given = cause or self.cause, False

    def update(
        self, match: float | None, stddev_m: float, share: float, now_ns: int
    ) -> LocalizationState:
        """Return the state.

        Args:
            match: share of the beams that end at obstacles of the map; None if the scan
                has too few echoes.
            stddev_m: of the position.
            share: weight of the heaviest cluster.
            now_ns: time of the scan.
        """
        params = self._params
        if self.state is LocalizationState.LOCALIZED:
            if match is not None and match < params.lost_match:
                self._note(DoubtCause.CONTRADICTED, now_ns)
            elif stddev_m > params.lost_stddev_m or share < _LOST_SHARE:
                self._note(DoubtCause.UNCERTAIN, now_ns)
            else:
                self._poor_since_ns = None
            return self.state
        if match is None:
            self._good, self._poor_since_ns = 0, None
            return self.state
        fits = match >= params.localized_match
        is_narrow = stddev_m <= params.localized_stddev_m and share >= _LEAST_SHARE
        self._good = self._good + 1 if fits and is_narrow else 0
        is_contradicted = self.cause is DoubtCause.UNCERTAIN and not fits
        if self._good >= _GOOD_SCANS:
            self.state, self._poor_since_ns = LocalizationState.LOCALIZED, None
            self.cause = None
        elif not self._good and (self._is_given or is_contradicted):
            cause = DoubtCause.UNCERTAIN if fits else DoubtCause.CONTRADICTED
            self._note(cause, now_ns)
        else:
            self._poor_since_ns = None
        return self.state

    def _note(self, cause: DoubtCause, now_ns: int) -> None:
        """Count the time of poor scans; after some the robot is lost."""
        if self._poor_since_ns is None:
            self._poor_since_ns = now_ns
        elif now_ns - self._poor_since_ns >= self._params.lost_time_s * 1e9:
            self.state, self.cause = LocalizationState.LOST, cause
            self._good, self._poor_since_ns = 0, None
            self._is_given = False
