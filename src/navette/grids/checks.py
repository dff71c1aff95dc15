"""Arrays that enter a kernel: the right type and shape, or a clear error.

Kernels are compiled for writable, aligned C-ordered arrays of one dtype. Anything else
would be compiled again (a second of waiting), so it is copied here instead.
"""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from navette.errors import InvalidValueError
from navette.grids.spec import GridSpec

Scalar = TypeVar("Scalar", bound=np.generic)


def kernel_array(
    name: str,
    array: NDArray[Any],
    dtype: type[Scalar],
    ndim: int = 2,
    *,
    allow_empty: bool = False,
) -> NDArray[Scalar]:
    """``array`` as a kernel takes it, copied only where it must be.

    Raises:
        InvalidValueError: not an array, of another dtype, or of other dimensions.
    """
    if not isinstance(array, np.ndarray):
        raise InvalidValueError(
            f"{name}: {type(array).__name__}, wanted a {np.dtype(dtype)} array"
        )
    if array.dtype != dtype:
        raise InvalidValueError(
            f"{name}: dtype {array.dtype}, wanted {np.dtype(dtype)}"
        )
    if array.ndim != ndim:
        raise InvalidValueError(f"{name}: {array.ndim}-D, wanted {ndim}-D")
    if array.size == 0 and not allow_empty:
        raise InvalidValueError(f"{name}: shape {array.shape} is empty")
    if array.flags.carray:  # C order, aligned, writable
        return array
    return np.array(array, order="C")


def output_array(
    name: str, array: NDArray[Any] | None, dtype: DTypeLike, shape: tuple[int, ...]
) -> NDArray[Any]:
    """``array`` if a kernel can write into it, a new one for ``None``."""
    if array is None:
        return np.empty(shape, dtype)
    if array.dtype != dtype or array.shape != shape:
        raise InvalidValueError(
            f"{name}: {array.dtype} {array.shape}, wanted {np.dtype(dtype)} {shape}"
        )
    if not array.flags.carray:
        raise InvalidValueError(f"{name}: wanted a writable C-ordered array")
    return array


def grid_array(
    name: str, array: NDArray[Any], dtype: type[Scalar], spec: GridSpec
) -> NDArray[Scalar]:
    """As :func:`kernel_array`, and of the size that ``spec`` tells."""
    checked = kernel_array(name, array, dtype)
    if checked.shape != spec.shape:
        raise InvalidValueError(
            f"{name}: shape {checked.shape}, wanted {spec.shape} (height, width)"
        )
    return checked


def at_least(name: str, value: float, minimum: float) -> None:
    """Raise unless ``value`` is finite and not below ``minimum``."""
    if not (np.isfinite(value) and value >= minimum):
        raise InvalidValueError(f"{name}: {value!r}, wanted a value >= {minimum:g}")
