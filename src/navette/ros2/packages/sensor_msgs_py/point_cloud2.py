"""sensor_msgs_py.point_cloud2: conversion of PointCloud2 to numpy arrays and back.

As in ROS 2, an organised cloud has shape (width, height) although its points are stored
row by row: ``points.reshape(cloud.height, cloud.width)`` is the image.
"""

import sys
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.lib.recfunctions import (
    structured_to_unstructured,
    unstructured_to_structured,
)
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.msgs.sensor_msgs.msg import PointCloud2, PointField
from navette.msgs.std_msgs.msg import Header

DUMMY_FIELD_PREFIX = "unnamed_field"

_DATATYPES: dict[int, np.dtype[Any]] = {
    PointField.INT8: np.dtype(np.int8),
    PointField.UINT8: np.dtype(np.uint8),
    PointField.INT16: np.dtype(np.int16),
    PointField.UINT16: np.dtype(np.uint16),
    PointField.INT32: np.dtype(np.int32),
    PointField.UINT32: np.dtype(np.uint32),
    PointField.FLOAT32: np.dtype(np.float32),
    PointField.FLOAT64: np.dtype(np.float64),
}


class PointCloudError(InvalidValueError, AssertionError):
    """A cloud, its fields and its points are inconsistent.

    Also an ``AssertionError``, which ROS 2's module raises.
    """


def read_points(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return the points as a structured array, a view of the data if possible.

    Args:
        field_names: the fields to read, in this order; default: all.
        skip_nans: leave out points with a NaN in a field that is read, unless the cloud
            ``is_dense``.
        uvs: indices of the points to return, counted after ``skip_nans``.
        reshape_organized_cloud: return shape (width, height) for an organised cloud.

    Raises:
        PointCloudError: a field does not exist, or the data is too short.
    """
    points: NDArray[Any] = _rows(cloud).reshape(-1)
    if field_names is not None:
        points = points[_known_names(field_names, points)]
    if not points.dtype.isnative:
        points = points.astype(points.dtype.newbyteorder("="))
    if skip_nans and not cloud.is_dense:
        points = points[_without_nans(points)]
    if uvs is not None:
        points = points[uvs if isinstance(uvs, np.ndarray) else np.fromiter(uvs, int)]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Return the points as an array (…, fields); the fields must have one type.

    Raises:
        PointCloudError: as :func:`read_points`, or the types differ.
    """
    points = read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    names = points.dtype.names or ()
    types = {name: points.dtype[name] for name in names}
    if len(set(types.values())) > 1:
        listed = ", ".join(f"{name} {kind}" for name, kind in types.items())
        raise PointCloudError(
            f"all fields must have the same datatype, got {listed}; "
            "pass field_names, or use read_points()"
        )
    plain: NDArray[Any] = structured_to_unstructured(points)
    return plain


def read_points_list(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
) -> list[Any]:
    """Return the points as named tuples of Python numbers; slow for large clouds."""
    points = read_points(cloud, field_names, skip_nans, uvs)
    Point = namedtuple("Point", points.dtype.names or (), rename=True)  # type: ignore[misc] # names come from a message
    return list(map(Point._make, points.tolist()))


def dtype_from_fields(
    fields: Iterable[PointField], point_step: int | None = None
) -> np.dtype[Any]:
    """Return the structured dtype of one point.

    A field with ``count`` > 1 becomes ``name_0``, ``name_1``, …; a field without a name
    becomes ``unnamed_field_<index>``.

    Args:
        point_step: bytes per point; default: the size of the fields.

    Raises:
        PointCloudError: unknown datatype, count 0, repeated name, or a field beyond
            ``point_step``.
    """
    names: list[str] = []
    formats: list[np.dtype[Any]] = []
    offsets: list[int] = []
    for number, field in enumerate(fields):
        scalar = _scalar_type(field)
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{number}"
        for part in range(field.count):
            names.append(f"{name}_{part}" if field.count > 1 else name)
            formats.append(scalar)
            offsets.append(field.offset + part * scalar.itemsize)
    layout: dict[str, Any] = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        layout["itemsize"] = point_step
    try:
        return np.dtype(layout)  # type: ignore[call-overload, no-any-return]
    except ValueError as error:
        raise PointCloudError(
            f"fields {', '.join(names)} with point_step {point_step}: {error}"
        ) from None


def create_cloud(
    header: Header,
    fields: Sequence[PointField],
    points: Any,
    point_step: int | None = None,
) -> PointCloud2:
    """Create a cloud in native byte order.

    Args:
        points: (N,) structured array with the fields' dtype; (N, fields) array if all
            fields have one type; or list of tuples. With one more dimension, (width,
            height, …), the cloud is organised.
        point_step: bytes per point; default: the size of the fields.

    Raises:
        PointCloudError: the points do not match the fields.
    """
    fields = list(fields)
    structured = _structured(points, dtype_from_fields(fields, point_step))
    if structured.ndim > 2:
        raise PointCloudError(
            f"points of shape {structured.shape}: expected one or two dimensions"
        )
    width = structured.shape[0]
    step = structured.dtype.itemsize
    return PointCloud2(
        header=header,
        height=structured.shape[1] if structured.ndim == 2 else 1,
        width=width,
        is_dense=False,
        is_bigendian=sys.byteorder != "little",
        fields=fields,
        point_step=step,
        row_step=step * width,
        data=structured.tobytes(),
    )


def create_cloud_xyz32(header: Header, points: Any) -> PointCloud2:
    """Create a cloud of float32 x, y, z from (N, 3) or (width, height, 3) points."""
    fields = [
        PointField(name=name, offset=offset, datatype=PointField.FLOAT32, count=1)
        for name, offset in (("x", 0), ("y", 4), ("z", 8))
    ]
    return create_cloud(header, fields, points)


def _rows(cloud: PointCloud2) -> NDArray[Any]:
    """Return a (height, width) view of the data, in which rows may be padded."""
    if not isinstance(cloud, PointCloud2):
        raise PointCloudError(
            f"expected a sensor_msgs/msg/PointCloud2, got {type(cloud).__name__}"
        )
    dtype = dtype_from_fields(cloud.fields, cloud.point_step)
    dtype = dtype.newbyteorder(">" if cloud.is_bigendian else "<")
    height, width, step = cloud.height, cloud.width, dtype.itemsize
    row_step = max(cloud.row_step, width * step)  # many publishers leave it 0
    if height <= 1:
        row_step = width * step
    needed = (height - 1) * row_step + width * step if height and width else 0
    data = np.asarray(cloud.data)
    if data.size < needed:
        raise PointCloudError(
            f"cloud of {width} × {height} points of {step} bytes: expected {needed} "
            f"bytes of data, got {data.size}"
        )
    return np.ndarray((height, width), dtype, data.data, strides=(row_step, step))


def _known_names(names: Iterable[str], points: NDArray[Any]) -> list[str]:
    names, known = list(names), points.dtype.names or ()
    unknown = [name for name in names if name not in known]
    if unknown:
        raise PointCloudError(
            f"no field {', '.join(map(repr, unknown))} in the cloud; "
            f"its fields: {', '.join(known)}"
        )
    return names


def _without_nans(points: NDArray[Any]) -> NDArray[np.bool_]:
    """Return a mask of the points without a NaN."""
    keep = np.ones(len(points), dtype=bool)
    for name in points.dtype.names or ():
        if points.dtype[name].kind == "f":
            keep &= ~np.isnan(points[name])
    return keep


def _scalar_type(field: PointField) -> np.dtype[Any]:
    if field.count <= 0:
        raise PointCloudError(f"field {field.name!r}: count 0 is not allowed")
    if field.datatype not in _DATATYPES:
        raise PointCloudError(
            f"field {field.name!r}: unknown datatype {field.datatype}; "
            "allowed: 1 (INT8) … 8 (FLOAT64)"
        )
    return _DATATYPES[field.datatype]


def _structured(points: Any, dtype: np.dtype[Any]) -> NDArray[Any]:
    if not isinstance(points, np.ndarray):
        return np.array(list(map(tuple, points)), dtype=dtype)
    if points.dtype.names is None:
        return _from_plain(points, dtype)
    if points.dtype != dtype:
        raise PointCloudError(
            f"points of dtype {points.dtype} do not match the fields: {dtype}"
        )
    return points


def _from_plain(points: NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    names = dtype.names or ()
    if len({dtype[name] for name in names}) > 1:
        raise PointCloudError(
            "all fields must have the same datatype; otherwise pass a structured array "
            f"of dtype {dtype}"
        )
    if points.ndim < 2 or points.shape[-1] != len(names):
        raise PointCloudError(
            f"points of shape {points.shape}: expected (…, {len(names)}) for "
            f"the fields {', '.join(names)}"
        )
    structured: NDArray[Any] = unstructured_to_structured(points, dtype=dtype)
    return structured
