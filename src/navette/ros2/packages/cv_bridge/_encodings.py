"""Encodings of image messages, and how to get from one to another.

Names: sensor_msgs/image_encodings. Colours are OpenCV's names of them; OpenCV names a
Bayer pattern by the second row's second and third pixel.
"""

import re
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

#: OpenCV's depths, in the order of its numbers → numpy's name.
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
    """An image or an encoding that cannot be converted."""


class Encoding(NamedTuple):
    """What the numbers of an image mean.

    ``colour`` is empty where they are no colours: a depth image, say.
    """

    dtype: str
    channels: int
    colour: str = ""

    @property
    def bits(self) -> int:
        return 8 * np.dtype(self.dtype).itemsize


@cache
def parsed(name: str) -> Encoding:
    """The encoding of that name.

    Raises:
        CvBridgeError: there is none.
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
        f"unrecognized image encoding {name!r}; wanted mono8, bgr8, rgb8, bgra8, "
        "rgba8, the same with 16, bayer_rggb8 and its like, yuv422, yuv422_yuy2, or "
        "8UC1 to 64FC4"
    )


def converted(image: NDArray[Any], source: str, wanted: str) -> NDArray[Any]:
    """The image in another encoding; between 8 and 16 bits values are stretched.

    Raises:
        CvBridgeError: there is no way from the one to the other.
    """
    if source == wanted:
        return image
    have, want = parsed(source), parsed(wanted)
    if have.colour and want.colour:
        if have.colour != want.colour:
            image = _recoloured(image, have.colour, want.colour)
    elif want.colour or have.channels != want.channels:
        raise CvBridgeError(
            f"no way from {source} to {wanted}: "
            + ("its numbers are no colours" if want.colour else "other channels")
        )
    return _with_depth(image, want)


def _recoloured(image: NDArray[Any], have: str, want: str) -> NDArray[Any]:
    import cv2

    is_yuv = have in _YUV.values()
    name = f"COLOR_YUV2{want}_{have}" if is_yuv else f"COLOR_{have}2{want}"
    code = getattr(cv2, name, None) if want in _CHANNELS else None
    if code is None:
        raise CvBridgeError(f"no way from {have} to {want} images")
    recoloured: NDArray[Any] = cv2.cvtColor(image, code)
    return recoloured


def _with_depth(image: NDArray[Any], want: Encoding) -> NDArray[Any]:
    dtype = np.dtype(want.dtype)
    if image.dtype == dtype:
        return image
    scale = {(8, 16): 65535 / 255, (16, 8): 255 / 65535}.get(
        (8 * image.dtype.itemsize, want.bits), 1.0
    )
    if dtype.kind == "f":
        return image.astype(dtype)
    limits = np.iinfo(dtype)
    scaled = np.nan_to_num(np.rint(image * np.float64(scale)))
    fitting: NDArray[Any] = np.clip(scaled, limits.min, limits.max).astype(dtype)
    return fitting
