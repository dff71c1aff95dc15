"""cv_bridge.core: conversion between image messages and OpenCV images."""

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.msgs.sensor_msgs.msg import CompressedImage, Image
from navette.msgs.std_msgs.msg import Header
from navette.ros2.packages.cv_bridge._encodings import (
    DEPTHS,
    CvBridgeError,
    converted,
    parsed,
)

__all__ = ["CvBridge", "CvBridgeError"]

_COLOURS = {1: "mono", 3: "bgr", 4: "bgra"}  # of files that OpenCV decodes


class CvBridge:
    """Converter of messages to arrays (height, width[, channels]) and back."""

    def __init__(self) -> None:
        import cv2

        self.numpy_type_to_cvtype = {value: key for key, value in DEPTHS.items()}
        self.numpy_type_to_cvtype.update(DEPTHS)
        self.cvdepth_to_numpy_depth: dict[int, str] = {
            getattr(cv2, f"CV_{name}"): dtype for name, dtype in DEPTHS.items()
        }
        # Difference of OpenCV's type numbers per channel; 8 before OpenCV 5.0.
        self._per_channel = int(cv2.CV_8UC2 - cv2.CV_8UC1)
        self.cvtype_to_name: dict[int, str] = {
            getattr(cv2, f"CV_{name}C{channels}"): f"{name}C{channels}"
            for name in DEPTHS
            for channels in (1, 2, 3, 4)
        }

    def imgmsg_to_cv2(
        self, img_msg: Image, desired_encoding: str = "passthrough"
    ) -> NDArray[Any]:
        """Return a copy of a message's image.

        Raises:
            CvBridgeError: unknown conversion, or too little data.
        """
        image = _pixels(img_msg)
        if desired_encoding == "passthrough":
            return image
        return converted(image, img_msg.encoding, desired_encoding)

    def compressed_imgmsg_to_cv2(
        self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough"
    ) -> NDArray[Any]:
        """Return the image of a compressed message; bgr, bgra or mono by default.

        Raises:
            CvBridgeError: unknown conversion, or the data is not an image.
        """
        import cv2

        data = np.asarray(cmprs_img_msg.data, dtype=np.uint8)
        found = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
        if found is None:
            raise CvBridgeError(
                f"compressed image of {data.size} bytes, format "
                f"{cmprs_img_msg.format!r}: OpenCV cannot decode it"
            )
        image: NDArray[Any] = found
        if desired_encoding == "passthrough":
            return image
        channels = image.shape[2] if image.ndim == 3 else 1
        encoding = f"{_COLOURS[channels]}{8 * image.dtype.itemsize}"
        return converted(image, encoding, desired_encoding)

    def cv2_to_imgmsg(
        self,
        cvim: NDArray[Any],
        encoding: str = "passthrough",
        header: Header | None = None,
    ) -> Image:
        """Return a message with the image; the default encoding is ``8UC3`` etc.

        Raises:
            CvBridgeError: the encoding has another data type or number of channels.
        """
        kind = self._kind(cvim)
        if encoding == "passthrough":
            encoding = kind
        elif parsed(encoding)[:2] != parsed(kind)[:2]:
            raise CvBridgeError(
                f"encoding specified as {encoding}, but image has incompatible type "
                f"{kind}"
            )
        height, width = cvim.shape[:2]
        message = Image(
            height=height,
            width=width,
            encoding=encoding,
            is_bigendian=_is_bigendian(cvim.dtype),
            step=width * parsed(kind).channels * cvim.dtype.itemsize,
            data=cvim.tobytes(),
        )
        if header is not None:
            message.header = header
        return message

    def cv2_to_compressed_imgmsg(
        self, cvim: NDArray[Any], dst_format: str = "jpg"
    ) -> CompressedImage:
        """Return a message with the image in a file format (jpg, png, …).

        Raises:
            CvBridgeError: OpenCV cannot write this image in that format.
        """
        import cv2

        kind = self._kind(cvim)
        try:
            _, data = cv2.imencode(f".{dst_format}", cvim)
        except cv2.error as error:
            raise CvBridgeError(f"{kind} image as {dst_format!r}: {error}") from error
        return CompressedImage(format=dst_format, data=data.tobytes())

    def dtype_with_channels_to_cvtype2(self, dtype: Any, n_channels: int) -> str:
        """Return ``8UC3`` for three channels of uint8."""
        name = np.dtype(dtype).name
        if name not in DEPTHS.values():
            raise CvBridgeError(
                f"OpenCV has no images of {name}; known: {', '.join(DEPTHS.values())}"
            )
        return f"{self.numpy_type_to_cvtype[name]}C{n_channels}"

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return ``("uint8", 3)`` for OpenCV's number ``CV_8UC3``."""
        more, depth = divmod(cvtype, self._per_channel)
        return self.cvdepth_to_numpy_depth[depth], more + 1

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return OpenCV's type number of an encoding."""
        dtype, channels = self.encoding_to_dtype_with_channels(encoding)
        name = self.numpy_type_to_cvtype[dtype]
        first = next(k for k, v in self.cvtype_to_name.items() if v == f"{name}C1")
        return first + self._per_channel * (channels - 1)

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return ``("uint8", 3)`` for ``bgr8``."""
        found = parsed(encoding)
        return found.dtype, found.channels

    def _kind(self, cvim: Any) -> str:
        if not isinstance(cvim, np.ndarray):
            raise TypeError(
                f"Your input type is not a numpy array, but {type(cvim).__name__}"
            )
        if cvim.ndim not in (2, 3):
            raise CvBridgeError(
                f"image of shape {cvim.shape}: expected (height, width) or "
                "(height, width, channels)"
            )
        channels = cvim.shape[2] if cvim.ndim == 3 else 1
        return self.dtype_with_channels_to_cvtype2(cvim.dtype, channels)


def _pixels(msg: Image) -> NDArray[Any]:
    """Return the pixels without row padding, in native byte order."""
    encoding = parsed(msg.encoding)
    dtype = np.dtype(encoding.dtype)
    pixel = encoding.channels * dtype.itemsize
    data = np.asarray(msg.data, dtype=np.uint8)
    if msg.step < msg.width * pixel or data.size < msg.height * msg.step:
        raise CvBridgeError(
            f"{msg.encoding} image of {msg.width} × {msg.height}, {msg.step} bytes "
            f"per row, {data.size} in total: expected at least {msg.width * pixel} per "
            f"row and {msg.height * max(msg.step, msg.width * pixel)} in total"
        )
    shape, strides = (msg.height, msg.width), (msg.step, pixel)
    if encoding.channels > 1:
        shape += (encoding.channels,)  # type: ignore[assignment]
        strides += (dtype.itemsize,)  # type: ignore[assignment]
    order = dtype.newbyteorder(">" if msg.is_bigendian else "<")
    return np.ndarray(shape, order, data.data, strides=strides).astype(dtype)


def _is_bigendian(dtype: "np.dtype[Any]") -> bool:
    if dtype.byteorder == "=":
        return sys.byteorder == "big"
    return dtype.byteorder == ">"
