"""Encodings of image messages and conversions between them.

The names are those of sensor_msgs/image_encodings, the colours OpenCV's. OpenCV names a
Bayer pattern after the second and third pixel of the second row.
"""

import re
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

#: OpenCV's depth, in the order of its numbers → numpy's name.
DEPTHS = {
    "8U": "uint8",
    "8S": "int8",
    "16U": "uint16",
    "16S": "int16",
    "32S": "int32",
    "32F": "float32",
    "64F": "float64",
}
_PLAIN = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)(?:C([0-9]{1,3}))?")
_COLOURS = {"mono": "GRAY", "rgb": "RGB", "bgr": "BGR", "rgba": "RGBA", "bgra": "BGRA"}
_CHANNELS = {"GRAY": 1, "RGB": 3, "BGR": 3, "RGBA": 4, "BGRA": 4}
_BAYER = {"rggb": "BG", "bggr": "RG", "gbrg": "GR", "grbg": "GB"}
_YUV = {"yuv422": "UYVY", "uyvy": "UYVY", "yuv422_yuy2": "YUY2", "yuyv": "YUY2"}


class CvBridgeError(TypeError):
    """The image or the encoding cannot be converted."""


class Encoding(NamedTuple):
    """Data type, channels and colour space of an image.

    ``colour`` is empty if the values are not colours, as in a depth image.
    """

    dtype: str
    channels: int
    colour: str = ""

    @property
    def bits(self) -> int:
        return 8 * np.dtype(self.dtype).itemsize


@cache
def parsed(name: str) -> Encoding:
    """Return the encoding of that name.

    Raises:
        CvBridgeError: the name is unknown.
    """
    plain = _PLAIN.fullmatch(name)
    if plain is not None:
        channels = int(plain[2] or 1)
        if 1 <= channels <= 512:  # OpenCV's limit
            return Encoding(DEPTHS[plain[1]], channels)
    if name in _YUV:
        return Encoding("uint8", 2, _YUV[name])
    stem, bits = name.rstrip("0123456789"), name[len(name.rstrip("0123456789")) :]
    pattern = stem.removeprefix("bayer_")
    if bits in ("8", "16"):
        if stem in _COLOURS:
            colour = _COLOURS[stem]
            return Encoding(f"uint{bits}", _CHANNELS[colour], colour)
        if stem != pattern and pattern in _BAYER:
            return Encoding(f"uint{bits}", 1, f"Bayer{_BAYER[pattern]}")
    raise CvBridgeError(
        f"unrecognized image encoding {name!r}; known: mono8, bgr8, rgb8, bgra8, "
        "rgba8, the same with 16, bayer_rggb8 and the other patterns, yuv422, "
        "yuv422_yuy2, and 8UC1 to 64FC4"
    )


def converted(image: NDArray[Any], source: str, target: str) -> NDArray[Any]:
    """Convert an image to another encoding; values are scaled between 8 and 16 bits.

    Raises:
        CvBridgeError: no conversion exists between the two encodings.
    """
    if source == target:
        return image
    old, new = parsed(source), parsed(target)
    if old.colour and new.colour:
        if old.colour != new.colour:
            image = _recoloured(image, old.colour, new.colour)
    elif new.colour or old.channels != new.channels:
        reason = (
            "values are not colours" if new.colour else "numbers of channels differ"
        )
        raise CvBridgeError(f"no conversion from {source} to {target}: {reason}")
    return _with_depth(image, new)


def _recoloured(image: NDArray[Any], old: str, new: str) -> NDArray[Any]:
    import cv2

    is_yuv = old in _YUV.values()
    name = f"COLOR_YUV2{new}_{old}" if is_yuv else f"COLOR_{old}2{new}"
    code = getattr(cv2, name, None) if new in _CHANNELS else None
    if code is None:
        raise CvBridgeError(f"no conversion from {old} to {new} images")
    recoloured: NDArray[Any] = cv2.cvtColor(image, code)
    return recoloured


def _with_depth(image: NDArray[Any], target: Encoding) -> NDArray[Any]:
    dtype = np.dtype(target.dtype)
    if image.dtype == dtype:
        return image
    scale = {(8, 16): 65535 / 255, (16, 8): 255 / 65535}.get(
        (8 * image.dtype.itemsize, target.bits), 1.0
    )
    if dtype.kind == "f":
        return image.astype(dtype)
    limits = np.iinfo(dtype)
    scaled = np.nan_to_num(np.rint(image * np.float64(scale)))
    fitting: NDArray[Any] = np.clip(scaled, limits.min, limits.max).astype(dtype)
    return fitting
