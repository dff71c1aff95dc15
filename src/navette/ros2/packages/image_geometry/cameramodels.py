"""image_geometry.cameramodels: pixels and points of cameras.

Points are metres in the camera's optical frame (x right, y down, z ahead); pixels are
(u, v) with u to the right. Matrices are ``numpy.matrix``, as programs expect of this
package: ``*`` multiplies them. Source: the definition of sensor_msgs/msg/CameraInfo.
"""

# ruff: noqa: N802 - the names are image_geometry's

import copy
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from navette.errors import InvalidValueError
from navette.msgs.sensor_msgs.msg import CameraInfo, RegionOfInterest

Pixel = tuple[float, float]
Point = tuple[float, float, float]


class PinholeCameraModel:
    """One camera, by its CameraInfo.

    ``K`` and ``P`` are those of the image as it is sent: scaled by the binning, moved
    by the region of interest. ``full_K`` and ``full_P`` are those of the whole sensor.
    """

    def __init__(self) -> None:
        self.K: Any = None  # (3, 3) of the raw image
        self.D: Any = None  # (n, 1) distortion coefficients; None if there are none
        self.R: Any = None  # (3, 3) rectification
        self.P: Any = None  # (3, 4) of the rectified image
        self.full_K: Any = None
        self.full_P: Any = None
        self.width: Any = None
        self.height: Any = None
        self.resolution: Any = None
        self.binning_x: Any = None
        self.binning_y: Any = None
        self.raw_roi: RegionOfInterest | None = None
        self.tf_frame: str | None = None
        self.stamp: Any = None
        self.mapx: Any = None  # of the last rectified image
        self.mapy: Any = None

    def fromCameraInfo(self, msg: CameraInfo) -> None:
        """Take the parameters of a message; a region of zeros is the whole image."""
        self.full_K, self.full_P = _matrix(3, 3, msg.k), _matrix(3, 4, msg.p)
        self.R = _matrix(3, 3, msg.r)
        self.D = _matrix(len(msg.d), 1, msg.d) if len(msg.d) else None
        self.width, self.height = msg.width, msg.height
        self.resolution = (msg.width, msg.height)
        self.binning_x = max(1, msg.binning_x)
        self.binning_y = max(1, msg.binning_y)
        roi = copy.copy(msg.roi)
        if not (roi.x_offset or roi.y_offset or roi.width or roi.height):
            roi.width, roi.height = self.width, self.height
        self.raw_roi = roi
        self.tf_frame = msg.header.frame_id
        self.stamp = msg.header.stamp
        self.K, self.P = self._as_sent(self.full_K), self._as_sent(self.full_P)

    def _as_sent(self, full: Any) -> Any:
        sent = full.copy()
        assert self.raw_roi is not None, "set just before"
        sent[0, 2] -= self.raw_roi.x_offset
        sent[1, 2] -= self.raw_roi.y_offset
        sent[0, [0, 2]] /= self.binning_x
        sent[1, [1, 2]] /= self.binning_y
        return sent

    # -- rectifying ------------------------------------------------------------

    def rectifyImage(self, raw: Any, rectified: Any) -> None:
        """Write the rectified image of ``raw`` into ``rectified``, of the same size."""
        import cv2

        self._check()
        height, width = raw.shape[:2]
        self.mapx, self.mapy = cv2.initUndistortRectifyMap(
            self.K, self.D, self.R, self.P, (width, height), cv2.CV_32FC1
        )
        cv2.remap(raw, self.mapx, self.mapy, cv2.INTER_CUBIC, rectified)

    def rectifyPoint(self, uv_raw: Sequence[float]) -> Any:
        """Where a pixel of the raw image is in the rectified one: (2,) array."""
        import cv2

        self._check()
        raw = np.array(uv_raw, dtype=np.float64).reshape(1, 1, 2)
        return cv2.undistortPoints(raw, self.K, self.D, R=self.R, P=self.P)[0, 0]

    # -- pixels of the rectified image and points ------------------------------

    def project3dToPixel(self, point: Sequence[float]) -> Pixel:
        """Where a point is seen; nan in the camera's own plane."""
        self._check()
        u, v, w = np.asarray(self.P) @ [point[0], point[1], point[2], 1.0]
        return (float(u / w), float(v / w)) if w != 0 else (math.nan, math.nan)

    def projectPixelTo3dRay(self, uv: Sequence[float]) -> Point:
        """The direction in which a pixel looks, of length 1."""
        x = (uv[0] - self.cx()) / self.fx()
        y = (uv[1] - self.cy()) / self.fy()
        norm = math.sqrt(x * x + y * y + 1.0)
        return x / norm, y / norm, 1.0 / norm

    def getDeltaU(self, deltaX: float, Z: float) -> float:
        """How many pixels to the right ``deltaX`` metres are at depth ``Z``."""
        return self.fx() * deltaX / Z if Z != 0 else math.inf

    def getDeltaV(self, deltaY: float, Z: float) -> float:
        """How many pixels down ``deltaY`` metres are at depth ``Z``."""
        return self.fy() * deltaY / Z if Z != 0 else math.inf

    def getDeltaX(self, deltaU: float, Z: float) -> float:
        """How many metres to the right ``deltaU`` pixels are at depth ``Z``."""
        return Z * deltaU / self.fx()

    def getDeltaY(self, deltaV: float, Z: float) -> float:
        """How many metres down ``deltaV`` pixels are at depth ``Z``."""
        return Z * deltaV / self.fy()

    # -- parameters ------------------------------------------------------------

    def fullResolution(self) -> tuple[int, int]:
        """Width and height of the whole sensor."""
        self._check()
        width, height = self.resolution
        return width, height

    def intrinsicMatrix(self) -> Any:
        return self.K

    def distortionCoeffs(self) -> Any:
        return self.D

    def rotationMatrix(self) -> Any:
        return self.R

    def projectionMatrix(self) -> Any:
        return self.P

    def fullIntrinsicMatrix(self) -> Any:
        return self.full_K

    def fullProjectionMatrix(self) -> Any:
        return self.full_P

    def cx(self) -> float:
        return self._projection(0, 2)

    def cy(self) -> float:
        return self._projection(1, 2)

    def fx(self) -> float:
        return self._projection(0, 0)

    def fy(self) -> float:
        return self._projection(1, 1)

    def Tx(self) -> float:
        """``-fx`` times the metres from the left camera of a pair; 0 for that one."""
        return self._projection(0, 3)

    def Ty(self) -> float:
        return self._projection(1, 3)

    def fovX(self) -> float:
        """Horizontal field of view of the whole sensor, radians."""
        self._check()
        return 2 * math.atan(self.width / (2 * float(self.full_P[0, 0])))

    def fovY(self) -> float:
        """Vertical field of view of the whole sensor, radians."""
        self._check()
        return 2 * math.atan(self.height / (2 * float(self.full_P[1, 1])))

    def tfFrame(self) -> str | None:
        """The frame that the parameters' message named."""
        return self.tf_frame

    def _projection(self, row: int, column: int) -> float:
        self._check()
        return float(self.P[row, column])

    def _check(self) -> None:
        if self.P is None:
            raise InvalidValueError(
                "camera model without parameters: call fromCameraInfo first"
            )


class StereoCameraModel:
    """Two cameras side by side, rectified: a point's two pixels are in one row.

    ``Q`` (4, 4) makes a point of (u, v, disparity, 1), with the left pixel.
    """

    def __init__(self) -> None:
        self.left = PinholeCameraModel()
        self.right = PinholeCameraModel()
        self.Q: Any = None

    def fromCameraInfo(self, left_msg: CameraInfo, right_msg: CameraInfo) -> None:
        """Take the parameters of both.

        Raises:
            InvalidValueError: the right one has no baseline.
        """
        self.left.fromCameraInfo(left_msg)
        self.right.fromCameraInfo(right_msg)
        if self.right.Tx() == 0:
            raise InvalidValueError(
                "right camera's P[0, 3] is 0: wanted -fx times the baseline; are left "
                "and right exchanged?"
            )
        left, fx, fy = self.left, self.left.fx(), self.left.fy()
        baseline = -self.right.Tx() / self.right.fx()
        self.Q = np.zeros((4, 4))
        self.Q[0, [0, 3]] = 1.0, -left.cx()
        self.Q[1, [1, 3]] = fx / fy, -left.cy() * fx / fy
        self.Q[2, 3] = fx
        self.Q[3, [2, 3]] = 1.0 / baseline, -self._offset() / baseline

    def _offset(self) -> float:
        """The disparity of a point that is infinitely far away."""
        return self.left.cx() - self.right.cx()

    def tfFrame(self) -> str | None:
        """The left camera's."""
        return self.left.tfFrame()

    def project3dToPixel(self, point: Sequence[float]) -> tuple[Pixel, Pixel]:
        """Where a point of the left camera's frame is seen, left and right."""
        return self.left.project3dToPixel(point), self.right.project3dToPixel(point)

    def projectPixelTo3d(self, left_uv: Sequence[float], disparity: float) -> Point:
        """The point at a left pixel; (0, 0, 0) if it is infinitely far away."""
        self.left._check()
        x, y, z, w = self.Q @ [left_uv[0], left_uv[1], disparity, 1.0]
        if w == 0:
            return 0.0, 0.0, 0.0
        return float(x / w), float(y / w), float(z / w)

    def getZ(self, disparity: float) -> float:
        """Depth (m) of what is seen with a disparity (pixels)."""
        shift = disparity - self._offset()
        return -self.right.Tx() / shift if shift != 0 else math.inf

    def getDisparity(self, Z: float) -> float:
        """Disparity (pixels) with which a depth (m) is seen."""
        return -self.right.Tx() / Z + self._offset() if Z != 0 else math.inf


def _matrix(rows: int, columns: int, values: Any) -> Any:
    """A matrix of its own; by a view, since the constructor warns of its class."""
    return np.array(values, dtype=np.float64).reshape(rows, columns).view(np.matrix)
