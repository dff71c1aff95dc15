"""cv_bridge: messages to images and back, encodings, compressed images."""

from typing import Any

import cv2
import numpy as np
import pytest

from navette.msgs.sensor_msgs.msg import CompressedImage, Image
from navette.msgs.std_msgs.msg import Header
from navette.ros2.packages.cv_bridge import CvBridge, CvBridgeError

BRIDGE = CvBridge()
DTYPES = ["uint8", "int8", "uint16", "int16", "int32", "float32", "float64"]


def noise(*shape: int, dtype: str = "uint8") -> Any:
    return np.random.default_rng(1).integers(0, 100, shape).astype(dtype)


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("shape", [(3, 4), (3, 4, 2), (3, 4, 3), (3, 4, 5)])
def test_a_message_and_its_image_are_equal(dtype: str, shape: tuple[int, ...]) -> None:
    image = noise(*shape, dtype=dtype)
    message = BRIDGE.cv2_to_imgmsg(image, header=Header(frame_id="cam"))
    assert (message.height, message.width, message.header.frame_id) == (3, 4, "cam")
    assert message.step * 3 == len(message.data) == image.nbytes
    again = BRIDGE.imgmsg_to_cv2(message)
    assert again.dtype == image.dtype
    np.testing.assert_array_equal(again, image)
    again[0, 0] = 7  # it is the program's own
    assert BRIDGE.imgmsg_to_cv2(message)[0, 0].tolist() == image[0, 0].tolist()


def test_one_channel_is_two_dimensional() -> None:
    message = BRIDGE.cv2_to_imgmsg(noise(3, 4, 1))
    assert message.encoding == "8UC1"
    assert BRIDGE.imgmsg_to_cv2(message).shape == (3, 4)


def test_padded_rows_and_swapped_bytes() -> None:
    image = noise(2, 3, dtype="uint16") * 100
    padded = np.zeros((2, 5), ">u2")
    padded[:, :3] = image
    message = Image(height=2, width=3, encoding="mono16", is_bigendian=True, step=10)
    message.data = padded.tobytes()
    found = BRIDGE.imgmsg_to_cv2(message)
    np.testing.assert_array_equal(found, image)
    assert found.dtype.isnative
    swapped = BRIDGE.cv2_to_imgmsg(image.astype(">u2"), "mono16")
    assert swapped.is_bigendian
    np.testing.assert_array_equal(BRIDGE.imgmsg_to_cv2(swapped), image)
    part = noise(4, 6, 3)[::2, ::2]  # not in one piece
    np.testing.assert_array_equal(
        BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(part, "bgr8")), part
    )


@pytest.mark.parametrize(
    ("source", "target", "code"),
    [
        ("rgb8", "bgr8", cv2.COLOR_RGB2BGR),
        ("bgr8", "mono8", cv2.COLOR_BGR2GRAY),
        ("mono8", "rgba8", cv2.COLOR_GRAY2RGBA),
        ("bgra8", "rgb8", cv2.COLOR_BGRA2RGB),
        ("bayer_rggb8", "bgr8", cv2.COLOR_BayerBG2BGR),
        ("bayer_grbg8", "rgb8", cv2.COLOR_BayerGB2RGB),
        ("yuv422", "bgr8", cv2.COLOR_YUV2BGR_UYVY),
        ("yuv422_yuy2", "mono8", cv2.COLOR_YUV2GRAY_YUY2),
    ],
)
def test_colours(source: str, target: str, code: int) -> None:
    channels = BRIDGE.encoding_to_dtype_with_channels(source)[1]
    image = noise(4, 6, channels) if channels > 1 else noise(4, 6)
    message = BRIDGE.cv2_to_imgmsg(image, source)
    np.testing.assert_array_equal(
        BRIDGE.imgmsg_to_cv2(message, target), cv2.cvtColor(image, code)
    )


def test_depths() -> None:
    grey = np.array([[0, 1, 255]], np.uint8)
    wide = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(grey, "mono8"), "mono16")
    assert wide.tolist() == [[0, 257, 65535]]
    back = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(wide, "mono16"), "mono8")
    assert back.tolist() == grey.tolist()
    colour = BRIDGE.cv2_to_imgmsg(noise(2, 2, 3), "rgb8")
    assert BRIDGE.imgmsg_to_cv2(colour, "mono16").dtype == np.uint16
    depth = np.array([[0.5, 1.5, -2.0, np.nan, 1e9]], np.float32)
    whole = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(depth, "32FC1"), "16UC1")
    assert whole.tolist() == [[0, 2, 0, 0, 65535]]
    far = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(depth[:, 4:] * 9), "32SC1")
    assert far.tolist() == [[2**31 - 1]]
    assert BRIDGE.imgmsg_to_cv2(colour, "8UC3").shape == (2, 2, 3)
    metres = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(wide, "16UC1"), "32FC1")
    assert metres.tolist() == [[0.0, 257.0, 65535.0]]


@pytest.mark.parametrize(
    ("source", "target", "error"),
    [
        ("8UC3", "mono8", "values are not colours"),
        ("bgr8", "8UC1", "numbers of channels differ"),
        ("bgr8", "bayer_rggb8", "from BGR to BayerBG"),
        ("bgr8", "wormhole8", "unrecognized image encoding 'wormhole8'"),
        ("bgr8", "8UC0", "unrecognized"),
    ],
)
def test_conversions_that_do_not_exist(source: str, target: str, error: str) -> None:
    message = BRIDGE.cv2_to_imgmsg(noise(2, 2, 3), source)
    with pytest.raises(CvBridgeError, match=error):
        BRIDGE.imgmsg_to_cv2(message, target)


def test_invalid_images() -> None:
    wrong: Any = [[1, 2]]
    with pytest.raises(TypeError, match="not a numpy array"):
        BRIDGE.cv2_to_imgmsg(wrong)
    with pytest.raises(CvBridgeError, match=r"specified as mono8, but .* 8UC3"):
        BRIDGE.cv2_to_imgmsg(noise(2, 2, 3), "mono8")
    with pytest.raises(CvBridgeError, match="no images of int64"):
        BRIDGE.cv2_to_imgmsg(noise(2, 2, dtype="int64"))
    with pytest.raises(CvBridgeError, match=r"shape \(2,\)"):
        BRIDGE.cv2_to_imgmsg(noise(2))
    short = Image(height=2, width=2, encoding="bgr8", step=6, data=bytes(11))
    with pytest.raises(CvBridgeError, match="6 per row and 12 in total"):
        BRIDGE.imgmsg_to_cv2(short)
    short.step = 5
    with pytest.raises(CvBridgeError, match="5 bytes per row"):
        BRIDGE.imgmsg_to_cv2(short)
    assert BRIDGE.imgmsg_to_cv2(Image(encoding="mono8")).shape == (0, 0)


def test_compressed_images() -> None:
    image = noise(8, 8, 3)
    message = BRIDGE.cv2_to_compressed_imgmsg(image, "png")
    assert message.format == "png"
    np.testing.assert_array_equal(BRIDGE.compressed_imgmsg_to_cv2(message), image)
    np.testing.assert_array_equal(
        BRIDGE.compressed_imgmsg_to_cv2(message, "rgb8"), image[:, :, ::-1]
    )
    grey = BRIDGE.cv2_to_compressed_imgmsg(noise(8, 8, dtype="uint16"), "png")
    assert BRIDGE.compressed_imgmsg_to_cv2(grey, "mono8").shape == (8, 8)
    assert len(BRIDGE.cv2_to_compressed_imgmsg(image).data) > 100
    with pytest.raises(CvBridgeError, match="as 'gig'"):
        BRIDGE.cv2_to_compressed_imgmsg(image, "gig")
    for data in (b"", b"no image"):
        with pytest.raises(CvBridgeError, match="OpenCV cannot decode it"):
            BRIDGE.compressed_imgmsg_to_cv2(CompressedImage(format="jpg", data=data))


def test_types() -> None:
    assert BRIDGE.encoding_to_cvtype2("bgr8") == cv2.CV_8UC3
    assert BRIDGE.encoding_to_cvtype2("64FC2") == cv2.CV_64FC2
    assert BRIDGE.cvtype2_to_dtype_with_channels(cv2.CV_16SC4) == ("int16", 4)
    assert BRIDGE.encoding_to_dtype_with_channels("bayer_bggr16") == ("uint16", 1)
    assert BRIDGE.dtype_with_channels_to_cvtype2(np.dtype("float32"), 2) == "32FC2"
    assert BRIDGE.cvtype_to_name[cv2.CV_32SC3] == "32SC3"
