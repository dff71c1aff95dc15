"""What the newest scans show about the pose of the robot."""

from enum import Enum, auto


class MatchStatus(Enum):
    """Why the pose is known, or not."""

    STARTING = auto()
    """The start pose was not compared with the known map yet."""
    MATCHED = auto()
    """The newest scan agrees with the map."""
    NO_ECHOES = auto()
    """Too few echoes to match; the pose follows from the odometry alone."""
    NOTHING_MAPPED = auto()
    """The scan sees nothing that is mapped, and contradicts nothing; likewise."""
    CONTRADICTED = auto()
    """The newest scan contradicts the map, others did not: people may pass by."""
    LOST_CONTRADICTED = auto()
    """Scans in a row contradict the map, or do not match where the robot started."""
    LOST_UNCERTAIN = auto()
    """The odometry alone led too far."""
    LOST_NO_ECHOES = auto()
    """The place is unknown, and the scan has too few echoes to find it."""
    LOST_NOWHERE = auto()
    """The place is unknown; what the robot sees fits nowhere in the map."""
    LOST_AMBIGUOUS = auto()
    """The place is unknown; what the robot sees fits at several places."""

    @property
    def is_lost(self) -> bool:
        """Whether the robot is searched for in the whole map."""
        return self.name.startswith("LOST")
