"""Cameras as JPEG for clients, made only while a client displays them.

A page on a phone cannot receive a camera's raw pixels. For each topic of images the
live view offers the topic that image_transport would: ``<topic>/compressed``.
"""

import io
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.msgs.sensor_msgs.msg import CompressedImage, Image
from navette.viewer.problem_reports import ProblemReports
from navette.viewer.token_bucket import TokenBucket
from navette.viewer.topic_ends import TopicEnd
from navette.viewer.wall_clock import WallClock

RAW, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
SUFFIX = "/compressed"

DeliverImage = Callable[[CompressedImage], None]
"""Receives the compressed images of a topic, on the compressor's thread."""

_QUALITY = 80
# Bytes of a pixel, and where red, green and blue are in it.
_COLOURS = {
    "rgb8": (3, (0, 1, 2)),
    "bgr8": (3, (2, 1, 0)),
    "rgba8": (4, (0, 1, 2)),
    "bgra8": (4, (2, 1, 0)),
    "8UC3": (3, (2, 1, 0)),
    "8UC4": (4, (2, 1, 0)),
}
_GREYS = ("mono8", "8UC1")
_DEPTHS = {"mono16": "u2", "16UC1": "u2", "32FC1": "f4"}


def compressed_ends(ends: Iterable[TopicEnd], node: str) -> list[TopicEnd]:
    """Return the publishers of ``node`` for images that no node compresses.

    Args:
        ends: the endpoints of the graph.
        node: full name of the live view's node.
    """
    published = {(end.topic, end.type_name) for end in ends if end.publishes}
    taken = {topic for topic, _ in published}
    return [
        TopicEnd(topic + SUFFIX, COMPRESSED, node, publishes=True)
        for topic, type_name in sorted(published)
        if type_name == RAW and topic + SUFFIX not in taken
    ]


def compress(image: Image) -> CompressedImage:
    """Return the image as JPEG; of depth, near is bright.

    Raises:
        InvalidValueError: the encoding is unknown or the data is too short.
    """
    from PIL import Image as Picture  # 40 ms that no start should cost

    buffer = io.BytesIO()
    Picture.fromarray(_pixels(image)).save(buffer, "JPEG", quality=_QUALITY)
    data = np.frombuffer(buffer.getvalue(), np.uint8)
    return CompressedImage(header=image.header, format="jpeg", data=data)


def _pixels(image: Image) -> NDArray[np.uint8]:
    """Return (H, W, 3) colours or (H, W) grey."""
    height, width, step = image.height, image.width, image.step
    known = [*_COLOURS, *_GREYS, *_DEPTHS]
    if image.encoding not in known:
        raise InvalidValueError(
            f"encoding {image.encoding!r:.80} cannot be compressed; "
            f"known: {', '.join(known)}"
        )
    size, order = _COLOURS.get(image.encoding, (1, (0,)))
    kind = np.dtype(_DEPTHS.get(image.encoding, "u1"))
    kind = kind.newbyteorder(">" if image.is_bigendian else "<")
    data = np.asarray(image.data, np.uint8)
    row = width * size * kind.itemsize
    if min(height, width) < 1 or step < row or data.size < step * height:
        raise InvalidValueError(
            f"image of {width} x {height} pixels, step {step} and {data.size} bytes; "
            f"expected a step of at least {row} and {max(step, row) * height} bytes"
        )
    rows = np.ascontiguousarray(data[: step * height].reshape(height, step)[:, :row])
    if image.encoding in _COLOURS:
        return np.ascontiguousarray(rows.reshape(height, width, size)[:, :, order])
    if image.encoding in _GREYS:
        return rows
    return _grey(rows.view(kind), is_depth=image.encoding != "mono16")


def _grey(values: NDArray[Any], *, is_depth: bool) -> NDArray[np.uint8]:
    """Return the range of the valid values as brightness; invalid ones are black."""
    valid = np.isfinite(values) & ((values > 0) if is_depth else True)
    if not valid.any():
        return np.zeros(values.shape, np.uint8)
    low, high = float(values[valid].min()), float(values[valid].max())
    share = (np.where(valid, values, low) - low) / max(high - low, 1e-9)
    grey = 255 - 235 * share if is_depth else 20 + 235 * share
    return np.where(valid, grey, 0).astype(np.uint8)


class ImageCompressor:
    """Compresses images in a thread of its own; drops images that come too soon.

    Args:
        rate_hz: most images per second of each topic.
    """

    def __init__(
        self, rate_hz: float, *, clock: WallClock, problems: ProblemReports
    ) -> None:
        self._rate_hz, self._clock, self._reports = rate_hz, clock, problems
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="navette-images")
        self._problems = set[str]()

    def stream(self, deliver: DeliverImage) -> "_Stream":
        """Return the receiver of one topic's images; ``deliver`` gets the results."""
        budget = TokenBucket(self._rate_hz, 1.0, self._clock)
        return _Stream(self, budget, deliver=deliver)

    def close(self) -> None:
        self._worker.shutdown(cancel_futures=True)

    def submit(self, work: Callable[[], None]) -> None:
        self._worker.submit(work)

    def note(self, problem: str) -> None:
        """Report a problem once."""
        if problem not in self._problems and len(self._problems) < 16:
            self._problems.add(problem)
            self._reports.image_refused(problem)


class _Stream:
    def __init__(
        self,
        compressor: ImageCompressor,
        budget: TokenBucket,
        *,
        deliver: DeliverImage,
    ) -> None:
        self._compressor, self._budget, self._deliver = compressor, budget, deliver
        self._is_busy = threading.Event()

    def __call__(self, image: Image) -> None:
        """Take an image; never blocks."""
        if self._is_busy.is_set() or not self._budget.try_take(1.0):
            return
        self._is_busy.set()
        self._compressor.submit(lambda: self._run(image))

    def _run(self, image: Image) -> None:
        try:
            self._deliver(compress(image))
        except InvalidValueError as error:
            self._compressor.note(str(error))
        finally:
            self._is_busy.clear()
