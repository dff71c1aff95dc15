"""image_geometry: projections, rectification, binning and regions, stereo."""

import math
from typing import Any

import cv2
import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.msgs.sensor_msgs.msg import CameraInfo, RegionOfInterest
from navette.ros2.packages.image_geometry import PinholeCameraModel, StereoCameraModel

POINT = (0.3, -0.2, 2.0)
DISTORTION = [-0.3, 0.1, 0.001, -0.002, 0.05]


def info(
    *, fx: float = 500.0, fy: float = 510.0, cx: float = 320.0, tx: float = 0.0
) -> CameraInfo:
    message = CameraInfo(
        width=640,
        height=480,
        distortion_model="plumb_bob",
        k=[fx, 0, cx, 0, fy, 240, 0, 0, 1],
        r=np.eye(3).ravel(),
        p=[fx, 0, cx, tx, 0, fy, 240, 0, 0, 0, 1, 0],
    )
    message.header.frame_id = "camera_optical"
    return message


def model(**changes: Any) -> PinholeCameraModel:
    message = info()
    for name, value in changes.items():
        setattr(message, name, value)
    camera = PinholeCameraModel()
    camera.fromCameraInfo(message)
    return camera


def test_a_point_and_its_pixel() -> None:
    camera = model()
    pixel = camera.project3dToPixel(POINT)
    assert pixel == pytest.approx((320 + 500 * 0.15, 240 - 510 * 0.1))
    ray = np.array(camera.projectPixelTo3dRay(pixel))
    np.testing.assert_allclose(ray, np.array(POINT) / np.linalg.norm(POINT))
    assert all(math.isnan(each) for each in camera.project3dToPixel((1.0, 0.0, 0.0)))


def test_parameters() -> None:
    camera = model(d=DISTORTION)
    assert (camera.fx(), camera.fy(), camera.cx(), camera.cy()) == (500, 510, 320, 240)
    assert (camera.Tx(), camera.Ty()) == (0, 0)
    assert camera.fovX() == pytest.approx(2 * math.atan(320 / 500))
    assert camera.fovY() == pytest.approx(2 * math.atan(240 / 510))
    assert camera.tfFrame() == "camera_optical"
    assert camera.fullResolution() == (640, 480)
    assert camera.distortionCoeffs().shape == (5, 1)
    assert camera.rotationMatrix().shape == (3, 3)
    np.testing.assert_array_equal(
        camera.fullIntrinsicMatrix(), camera.intrinsicMatrix()
    )
    seen = camera.projectionMatrix() @ np.array([[*POINT, 1.0]]).T
    assert seen[0, 0] / seen[2, 0] == pytest.approx(camera.project3dToPixel(POINT)[0])
    assert model().distortionCoeffs() is None


def test_distances_at_a_depth() -> None:
    camera = model()
    assert camera.getDeltaU(0.5, 2.0) == pytest.approx(125)
    assert camera.getDeltaV(0.5, 2.0) == pytest.approx(127.5)
    assert camera.getDeltaX(125.0, 2.0) == pytest.approx(0.5)
    assert camera.getDeltaY(127.5, 2.0) == pytest.approx(0.5)
    assert camera.getDeltaU(0.5, 0.0) == camera.getDeltaV(0.5, 0.0) == math.inf


def test_binning_and_region_of_interest() -> None:
    roi = RegionOfInterest(x_offset=100, y_offset=40, width=400, height=300)
    camera = model(binning_x=2, binning_y=4, roi=roi)
    u, v = model().project3dToPixel(POINT)
    assert camera.project3dToPixel(POINT) == pytest.approx(
        ((u - 100) / 2, (v - 40) / 4)
    )
    assert camera.fovX() == model().fovX()
    assert camera.fullProjectionMatrix()[0, 0] == 500
    assert camera.intrinsicMatrix()[0, 2] == 110
    assert camera.raw_roi == roi


def test_distortion_is_removed() -> None:
    camera = model(d=DISTORTION)
    zero, point = np.zeros(3), (0.8, -0.6, 2.0)
    raw, _ = cv2.projectPoints(
        np.array([point]), zero, zero, camera.K, np.array(DISTORTION)
    )
    assert np.linalg.norm(raw.ravel() - camera.project3dToPixel(point)) > 2
    np.testing.assert_allclose(
        camera.rectifyPoint(tuple(raw.ravel())),
        camera.project3dToPixel(point),
        atol=0.1,
    )


def test_an_image_is_rectified() -> None:
    camera = model(d=DISTORTION)
    raw = np.zeros((480, 640), np.uint8)
    zero = np.zeros(3)
    seen, _ = cv2.projectPoints(
        np.array([POINT]), zero, zero, camera.K, np.array(DISTORTION)
    )
    cv2.circle(raw, tuple(round(float(each)) for each in seen.ravel()), 4, 255, -1)
    rectified = np.zeros_like(raw)
    camera.rectifyImage(raw, rectified)
    rows, columns = np.nonzero(rectified > 128)
    np.testing.assert_allclose(
        (columns.mean(), rows.mean()), camera.project3dToPixel(POINT), atol=1.0
    )


def test_a_model_without_parameters() -> None:
    with pytest.raises(InvalidValueError, match="fromCameraInfo first"):
        PinholeCameraModel().project3dToPixel(POINT)
    with pytest.raises(InvalidValueError, match="fromCameraInfo first"):
        StereoCameraModel().projectPixelTo3d((0, 0), 1)
    stereo = StereoCameraModel()
    with pytest.raises(InvalidValueError, match="may be swapped"):
        stereo.fromCameraInfo(info(tx=-60.0), info())


@pytest.mark.parametrize("right_cx", [320.0, 300.0])
def test_a_stereo_pair(right_cx: float) -> None:
    stereo = StereoCameraModel()
    stereo.fromCameraInfo(info(), info(cx=right_cx, tx=-500 * 0.12))
    left, right = stereo.project3dToPixel(POINT)
    disparity = left[0] - right[0]
    assert left[1] == right[1]
    assert stereo.projectPixelTo3d(left, disparity) == pytest.approx(POINT)
    assert stereo.getZ(disparity) == pytest.approx(2.0)
    assert stereo.getDisparity(2.0) == pytest.approx(disparity)
    far = 320.0 - right_cx
    assert stereo.projectPixelTo3d(left, far) == (0.0, 0.0, 0.0)
    assert stereo.getZ(far) == stereo.getDisparity(0.0) == math.inf
    assert stereo.tfFrame() == "camera_optical"
