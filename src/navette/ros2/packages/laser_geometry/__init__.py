"""laser_geometry: conversion of scans to point clouds."""

# ruff: noqa: N802 - the names are laser_geometry's

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.msgs.sensor_msgs.msg import LaserScan, PointCloud2, PointField
from navette.ros2.packages.sensor_msgs_py.point_cloud2 import (
    create_cloud,
    dtype_from_fields,
)

__all__ = ["LaserProjection"]


class LaserProjection:
    """Converter of the hits of a scan to a cloud in the scan's frame.

    A hit is a range of at least ``range_min`` and below ``range_max``; other ranges,
    nan and inf are left out. The directions of the beams are cached.
    """

    LASER_SCAN_INVALID = -1.0
    LASER_SCAN_MIN_RANGE = -2.0
    LASER_SCAN_MAX_RANGE = -3.0

    class ChannelOption:
        """Further fields of a point, combined with ``|``."""

        NONE = 0x00
        INTENSITY = 0x01  # "intensity", if the scan has any
        INDEX = 0x02  # "index": of the beam
        DISTANCE = 0x04  # "distances", metres
        TIMESTAMP = 0x08  # "stamps": seconds after the scan's stamp
        VIEWPOINT = 0x10  # "vp_x", "vp_y", "vp_z": position of the scanner, 0
        DEFAULT = INTENSITY | INDEX

    _CHANNELS: ClassVar = (
        (ChannelOption.INTENSITY, ("intensity",)),
        (ChannelOption.INDEX, ("index",)),
        (ChannelOption.DISTANCE, ("distances",)),
        (ChannelOption.TIMESTAMP, ("stamps",)),
        (ChannelOption.VIEWPOINT, ("vp_x", "vp_y", "vp_z")),
    )

    def __init__(self) -> None:
        self._angles = (0, 0.0, 0.0)  # of the directions: number, first, increment
        self._directions = np.zeros((2, 0))

    def projectLaser(
        self,
        scan_in: LaserScan,
        range_cutoff: float = -1.0,
        channel_options: int = ChannelOption.DEFAULT,
    ) -> PointCloud2:
        """Return the cloud of a scan with a point for each hit, in order of the beams.

        Args:
            range_cutoff: upper limit of ranges in m; negative: no limit.
            channel_options: further fields, of :class:`ChannelOption`.

        Raises:
            InvalidValueError: the numbers of intensities and ranges differ.
        """
        ranges = np.asarray(scan_in.ranges)
        if scan_in.intensities and len(scan_in.intensities) != len(ranges):
            raise InvalidValueError(
                f"scan with {len(ranges)} ranges and {len(scan_in.intensities)} "
                "intensities: expected the same number, or none"
            )
        farthest = scan_in.range_max
        if range_cutoff >= 0:
            farthest = min(range_cutoff, farthest)
        hits = np.flatnonzero((ranges >= scan_in.range_min) & (ranges < farthest))
        fields = self._fields(scan_in, channel_options)
        points = np.zeros(len(hits), dtype_from_fields(fields))
        x, y = ranges[hits] * self._directions_of(scan_in)[:, hits]
        values: dict[str, Any] = {
            "x": x,
            "y": y,
            "index": hits,
            "distances": ranges[hits],
            "stamps": hits * scan_in.time_increment,
        }
        if scan_in.intensities:
            values["intensity"] = np.asarray(scan_in.intensities)[hits]
        for name in values.keys() & set(points.dtype.names or ()):
            points[name] = values[name]
        return create_cloud(scan_in.header, fields, points)

    def _fields(self, scan: LaserScan, options: int) -> list[PointField]:
        if not scan.intensities:
            options &= ~self.ChannelOption.INTENSITY
        names = ["x", "y", "z"]
        for option, channels in self._CHANNELS:
            names += channels if options & option else ()
        return [
            PointField(
                name=name,
                offset=4 * i,
                datatype=PointField.INT32 if name == "index" else PointField.FLOAT32,
                count=1,
            )
            for i, name in enumerate(names)
        ]

    def _directions_of(self, scan: LaserScan) -> NDArray[np.float64]:
        """Return cosine and sine of each beam's angle, shape (2, N)."""
        angles_of_scan = len(scan.ranges), scan.angle_min, scan.angle_increment
        if self._angles != angles_of_scan:
            angles = (
                scan.angle_min + np.arange(angles_of_scan[0]) * scan.angle_increment
            )
            self._directions = np.array([np.cos(angles), np.sin(angles)])
            self._angles = angles_of_scan
        return self._directions
