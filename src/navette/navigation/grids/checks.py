"""Checks of inputs: frames; arrays that enter a kernel: type, shape, memory layout.

Kernels are compiled for writable, aligned C-ordered arrays of one dtype. Other arrays
are copied or refused here, because Numba would compile the kernel again (a second).
"""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from navette.errors import InvalidInputError, InvalidValueError
from navette.navigation.grids.spec import GridSpec

Scalar = TypeVar("Scalar", bound=np.generic)


def kernel_array(
    name: str,
    array: NDArray[Any],
    dtype: type[Scalar],
    ndim: int = 2,
    *,
    allow_empty: bool = False,
) -> NDArray[Scalar]:
    """Return ``array`` in the layout of kernels, copied only if necessary.

    Raises:
        InvalidValueError: not an array, or another dtype or number of dimensions.
    """
    if not isinstance(array, np.ndarray):
        raise InvalidValueError(
            f"{name}: {type(array).__name__}, expected a {np.dtype(dtype)} array"
        )
    if array.dtype != dtype:
        raise InvalidValueError(
            f"{name}: dtype {array.dtype}, expected {np.dtype(dtype)}"
        )
    if array.ndim != ndim:
        raise InvalidValueError(f"{name}: {array.ndim}-D, expected {ndim}-D")
    if array.size == 0 and not allow_empty:
        raise InvalidValueError(f"{name}: shape {array.shape} is empty")
    if array.flags.carray:  # C order, aligned, writable
        return array
    return np.array(array, order="C")


def output_array(
    name: str, array: NDArray[Any], dtype: DTypeLike, shape: tuple[int, ...]
) -> NDArray[Any]:
    """Return ``array`` if a kernel can write into it.

    Raises:
        InvalidValueError: another dtype or shape, read-only, or not C-ordered.
    """
    if array.dtype != dtype or array.shape != shape:
        raise InvalidValueError(
            f"{name}: {array.dtype} {array.shape}, expected {np.dtype(dtype)} {shape}"
        )
    if not array.flags.carray:
        raise InvalidValueError(f"{name}: not a writable C-ordered array")
    return array


def grid_array(
    name: str, array: NDArray[Any], dtype: type[Scalar], spec: GridSpec
) -> NDArray[Scalar]:
    """Return the array as :func:`kernel_array` does, if it has the shape of ``spec``.

    Raises:
        InvalidValueError: another dtype or shape.
    """
    checked = kernel_array(name, array, dtype)
    if checked.shape != spec.shape:
        raise InvalidValueError(
            f"{name}: shape {checked.shape}, expected {spec.shape} (height, width)"
        )
    return checked


def at_least(name: str, value: float, minimum: float) -> None:
    """Raise InvalidValueError unless ``value`` is finite and >= ``minimum``."""
    if not (np.isfinite(value) and value >= minimum):
        raise InvalidValueError(f"{name}: {value!r}, must be >= {minimum:g}")


def check_frame(what: str, frame_id: str, expected: str) -> None:
    """Raise InvalidInputError unless a message is in the stage's map frame."""
    if frame_id != expected:
        raise InvalidInputError(
            "unknown_frame",
            f"{what} in frame {frame_id!r}; expected map_frame, {expected!r}: "
            "transform it, or set map_frame",
        )
