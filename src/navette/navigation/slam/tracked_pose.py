"""Pose of the robot between key scans, with its uncertainty."""

from typing import NamedTuple

import numpy as np

from navette.geometry import Pose2
from navette.navigation.slam.motion import (
    HERE,
    Matrix3,
    ScanMotion,
    inverted,
    moved_covariance,
    section_covariance,
)
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import Refined

STILL = ScanMotion(HERE, np.zeros((3, 3)))
"""No motion, known exactly."""


class _Segment(NamedTuple):
    """A motion by odometry alone, and what was known where it began."""

    pose: Pose2
    covariance: Matrix3
    since_key: ScanMotion
    motion: Pose2


class TrackedPose:
    """Pose that each scan moves: by its match, or by the odometry alone.

    Attributes:
        pose: map_T_base.
        covariance: (3, 3) of x, y, m, and yaw, rad, in the map's axes, relative to the
            key scans around the robot.
        since_key: motion since the newest key scan, without matching.

    Args:
        pose: the first pose.
        covariance: of it.
    """

    _segment: _Segment

    def __init__(self, pose: Pose2, covariance: Matrix3) -> None:
        self.since_key = STILL
        self.place(pose, covariance)

    def place(self, pose: Pose2, covariance: Matrix3) -> None:
        """Set the pose and its covariance (3, 3)."""
        self.pose, self.covariance = pose, covariance
        self._begin_segment()

    def note_key(self) -> None:
        """Measure the motion from here on: the scan became a key scan."""
        self.since_key = STILL
        self._begin_segment()

    def predicted(self, motion: ScanMotion) -> Matrix3:
        """Return the covariance (3, 3) after a motion."""
        return moved_covariance(self.covariance, self.pose, motion)

    def match(self, motion: ScanMotion, matched: Refined) -> None:
        """Move to where a scan matched, after a motion of the prediction."""
        information = inverted(self.predicted(motion)) + matched.information
        self.since_key = _composed(self.since_key, motion)
        self.place(matched.pose, inverted(information))

    def move(self, motion: ScanMotion) -> None:
        """Move by a prediction whose errors add up scan by scan."""
        self.since_key = _composed(self.since_key, motion)
        self.place(self.pose @ motion.pose, self.predicted(motion))

    def reckon(self, motion: Pose2, params: SlamParams) -> None:
        """Move by the odometry alone.

        The covariance is that of the whole motion since the last match or key scan. The
        odometry's errors of single scans do not add up: a robot that stands stays as
        certain as it was.
        """
        start = self._segment
        whole = start.motion @ motion
        made = ScanMotion(whole, section_covariance(whole, params))
        self.pose = self.pose @ motion
        self.covariance = moved_covariance(start.covariance, start.pose, made)
        self.since_key = _composed(start.since_key, made)
        self._segment = start._replace(motion=whole)

    def _begin_segment(self) -> None:
        self._segment = _Segment(self.pose, self.covariance, self.since_key, HERE)


def _composed(before: ScanMotion, after: ScanMotion) -> ScanMotion:
    return ScanMotion(
        before.pose @ after.pose,
        moved_covariance(before.covariance, before.pose, after),
    )
