"""image_geometry.cameramodels: camera models for pixels and points.

Points are in m in the camera's optical frame (x right, y down, z forward); pixels are
(u, v) with u to the right. Matrices are ``numpy.matrix``, as in ROS 2: ``*`` multiplies
them. Source: the definition of sensor_msgs/msg/CameraInfo.
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
    """Model of one camera from its CameraInfo.

    ``K`` and ``P`` belong to the published image: they include binning and the region
    of interest. ``full_K`` and ``full_P`` belong to the whole sensor.
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
        """Set the parameters; a region of interest of zeros is the whole image."""
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
        self.K, self.P = self._cropped(self.full_K), self._cropped(self.full_P)

    def _cropped(self, full: Any) -> Any:
        cropped = full.copy()
        assert self.raw_roi is not None, "set by the caller"
        cropped[0, 2] -= self.raw_roi.x_offset
        cropped[1, 2] -= self.raw_roi.y_offset
        cropped[0, [0, 2]] /= self.binning_x
        cropped[1, [1, 2]] /= self.binning_y
        return cropped

    def rectifyImage(self, raw: Any, rectified: Any) -> None:
        """Write the rectified image into ``rectified``, which has the same size."""
        import cv2

        self._check()
        height, width = raw.shape[:2]
        self.mapx, self.mapy = cv2.initUndistortRectifyMap(
            self.K, self.D, self.R, self.P, (width, height), cv2.CV_32FC1
        )
        cv2.remap(raw, self.mapx, self.mapy, cv2.INTER_CUBIC, rectified)

    def rectifyPoint(self, uv_raw: Sequence[float]) -> Any:
        """Return the rectified position (2,) of a pixel of the raw image."""
        import cv2

        self._check()
        raw = np.array(uv_raw, dtype=np.float64).reshape(1, 1, 2)
        return cv2.undistortPoints(raw, self.K, self.D, R=self.R, P=self.P)[0, 0]

    def project3dToPixel(self, point: Sequence[float]) -> Pixel:
        """Return the pixel of a point; nan in the camera's plane."""
        self._check()
        u, v, w = np.asarray(self.P) @ [point[0], point[1], point[2], 1.0]
        return (float(u / w), float(v / w)) if w != 0 else (math.nan, math.nan)

    def projectPixelTo3dRay(self, uv: Sequence[float]) -> Point:
        """Return the unit vector of a pixel's direction."""
        x = (uv[0] - self.cx()) / self.fx()
        y = (uv[1] - self.cy()) / self.fy()
        norm = math.sqrt(x * x + y * y + 1.0)
        return x / norm, y / norm, 1.0 / norm

    def getDeltaU(self, deltaX: float, Z: float) -> float:
        """Return the horizontal distance in pixels of ``deltaX`` m at depth ``Z`` m."""
        return self.fx() * deltaX / Z if Z != 0 else math.inf

    def getDeltaV(self, deltaY: float, Z: float) -> float:
        """Return the vertical distance in pixels of ``deltaY`` m at depth ``Z`` m."""
        return self.fy() * deltaY / Z if Z != 0 else math.inf

    def getDeltaX(self, deltaU: float, Z: float) -> float:
        """Return the horizontal distance in m of ``deltaU`` pixels at depth ``Z`` m."""
        return Z * deltaU / self.fx()

    def getDeltaY(self, deltaV: float, Z: float) -> float:
        """Return the vertical distance in m of ``deltaV`` pixels at depth ``Z`` m."""
        return Z * deltaV / self.fy()

    def fullResolution(self) -> tuple[int, int]:
        """Return width and height of the whole sensor in pixels."""
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
        """Return ``-fx`` times the distance (m) to the left camera of a stereo pair."""
        return self._projection(0, 3)

    def Ty(self) -> float:
        return self._projection(1, 3)

    def fovX(self) -> float:
        """Return the horizontal field of view of the whole sensor in rad."""
        self._check()
        return 2 * math.atan(self.width / (2 * float(self.full_P[0, 0])))

    def fovY(self) -> float:
        """Return the vertical field of view of the whole sensor in rad."""
        self._check()
        return 2 * math.atan(self.height / (2 * float(self.full_P[1, 1])))

    def tfFrame(self) -> str | None:
        return self.tf_frame

    def _projection(self, row: int, column: int) -> float:
        self._check()
        return float(self.P[row, column])

    def _check(self) -> None:
        if self.P is None:
            raise InvalidValueError(
                "the camera model has no parameters; call fromCameraInfo first"
            )


class StereoCameraModel:
    """Model of a rectified stereo pair: the two pixels of a point are in one row.

    ``Q`` (4, 4) converts (u, v, disparity, 1) of the left image to a point.
    """

    def __init__(self) -> None:
        self.left = PinholeCameraModel()
        self.right = PinholeCameraModel()
        self.Q: Any = None

    def fromCameraInfo(self, left_msg: CameraInfo, right_msg: CameraInfo) -> None:
        """Set the parameters of both cameras.

        Raises:
            InvalidValueError: the right camera has no baseline.
        """
        self.left.fromCameraInfo(left_msg)
        self.right.fromCameraInfo(right_msg)
        if self.right.Tx() == 0:
            raise InvalidValueError(
                "P[0, 3] of the right camera is 0, expected -fx times the baseline; "
                "the cameras may be swapped"
            )
        left, fx, fy = self.left, self.left.fx(), self.left.fy()
        baseline = -self.right.Tx() / self.right.fx()
        self.Q = np.zeros((4, 4))
        self.Q[0, [0, 3]] = 1.0, -left.cx()
        self.Q[1, [1, 3]] = fx / fy, -left.cy() * fx / fy
        self.Q[2, 3] = fx
        self.Q[3, [2, 3]] = 1.0 / baseline, -self._offset() / baseline

    def _offset(self) -> float:
        """Return the disparity of a point at infinity."""
        return self.left.cx() - self.right.cx()

    def tfFrame(self) -> str | None:
        return self.left.tfFrame()

    def project3dToPixel(self, point: Sequence[float]) -> tuple[Pixel, Pixel]:
        """Return the left and the right pixel of a point in the left camera's frame."""
        return self.left.project3dToPixel(point), self.right.project3dToPixel(point)

    def projectPixelTo3d(self, left_uv: Sequence[float], disparity: float) -> Point:
        """Return the point of a left pixel; (0, 0, 0) for a point at infinity."""
        self.left._check()
        x, y, z, w = self.Q @ [left_uv[0], left_uv[1], disparity, 1.0]
        if w == 0:
            return 0.0, 0.0, 0.0
        return float(x / w), float(y / w), float(z / w)

    def getZ(self, disparity: float) -> float:
        """Return the depth (m) for a disparity (pixels)."""
        shift = disparity - self._offset()
        return -self.right.Tx() / shift if shift != 0 else math.inf

    def getDisparity(self, Z: float) -> float:
        """Return the disparity (pixels) for a depth (m)."""
        return -self.right.Tx() / Z + self._offset() if Z != 0 else math.inf


def _matrix(rows: int, columns: int, values: Any) -> Any:
    """Return a numpy.matrix; as a view, because its constructor emits a warning."""
    return np.array(values, dtype=np.float64).reshape(rows, columns).view(np.matrix)
