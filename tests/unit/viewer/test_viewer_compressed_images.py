"""Cameras as JPEG for clients."""

import io
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image as Picture
from viewer_harness import Client, Program

from navette.errors import InvalidValueError
from navette.msgs import deserialize
from navette.msgs.sensor_msgs.msg import CompressedImage, Image
from navette.msgs.std_msgs.msg import Header
from navette.runtime import Context, Node
from navette.viewer.compressed_images import compress, compressed_ends
from navette.viewer.topic_ends import TopicEnd

RED = np.zeros((24, 32, 3), np.uint8)
RED[:, :, 0] = 230


def image(pixels: NDArray[Any], encoding: str, *, padding: int = 0) -> Image:
    rows = np.ascontiguousarray(pixels).view(np.uint8).reshape(len(pixels), -1)
    data = np.pad(rows, ((0, 0), (0, padding)))
    return Image(
        header=Header(frame_id="camera"),
        height=pixels.shape[0],
        width=pixels.shape[1],
        encoding=encoding,
        step=data.shape[1],
        data=data.ravel(),
    )


def pixels_of(message: CompressedImage) -> NDArray[np.uint8]:
    assert message.format == "jpeg"
    return np.asarray(Picture.open(io.BytesIO(bytes(message.data))))


@pytest.mark.parametrize(
    ("encoding", "order"), [("rgb8", (0, 1, 2)), ("bgr8", (2, 1, 0))]
)
def test_colours_stay(encoding: str, order: tuple[int, ...]) -> None:
    message = compress(image(RED[:, :, order], encoding, padding=5))
    assert message.header.frame_id == "camera"
    shown = pixels_of(message)
    assert shown.shape == RED.shape
    assert np.abs(shown.astype(int) - RED).max() < 12


def test_grey_stays() -> None:
    grey = np.full((16, 16), 100, np.uint8)
    assert np.abs(pixels_of(compress(image(grey, "mono8"))).astype(int) - 100).max() < 4


@pytest.mark.parametrize(("encoding", "kind"), [("16UC1", "<u2"), ("32FC1", "<f4")])
def test_near_is_bright_and_invalid_is_black(encoding: str, kind: str) -> None:
    depth = np.zeros((16, 48), kind)
    depth[:, 16:32], depth[:, 32:] = 1, 9
    shown = pixels_of(compress(image(depth, encoding)))
    assert shown[8, 8] < 10
    assert shown[8, 24] > 240
    assert 10 < shown[8, 40] < 40


@pytest.mark.parametrize(
    "wrong",
    [
        image(RED, "bayer_rggb8"),
        Image(height=10, width=10, encoding="rgb8", step=30, data=np.zeros(9, "u1")),
        Image(height=10, width=10, encoding="rgb8", step=3, data=np.zeros(300, "u1")),
        Image(encoding="rgb8"),
        Image(height=2**32 - 1, width=2**32 - 1, encoding="mono8", step=2**32 - 1),
    ],
)
def test_other_images_are_refused(wrong: Image) -> None:
    with pytest.raises(InvalidValueError, match=r"expected|known"):
        compress(wrong)


def test_images_that_are_compressed_elsewhere_are_left_alone() -> None:
    def end(topic: str, name: str) -> TopicEnd:
        return TopicEnd(topic, f"sensor_msgs/msg/{name}", "/camera", publishes=True)

    ends = [
        end("/a", "Image"),
        end("/b", "Image"),
        end("/b/compressed", "CompressedImage"),
    ]
    [made] = compressed_ends(ends, "/viewer")
    assert (made.topic, made.node) == ("/a/compressed", "/viewer")
    assert made.type_name == "sensor_msgs/msg/CompressedImage"


class Camera(Node):
    def __init__(self, context: Context) -> None:
        super().__init__("camera", context=context)
        self.images = self.create_publisher(Image, "/camera", 10)
        self.create_timer(0.02, lambda: self.images.publish(image(RED, "rgb8")))


def test_a_camera_is_compressed_while_a_client_displays_it() -> None:
    with Program(Camera, image_rate_hz=100.0) as program:
        camera = program.nodes[0]
        assert isinstance(camera, Camera)
        with Client(program.address) as client:
            client.subscribe("/camera/compressed", 1)
            message = deserialize(client.message(1)[1], CompressedImage)
            assert pixels_of(message).shape == RED.shape
        while program.do(camera.images.get_subscription_count):
            pass
