"""Files of scan graphs: key scans, measurements and poses, to continue a map.

A file is a NumPy archive (``.npz``) of plain arrays; it is read within a budget and
without pickles. The same graph gives the same bytes.
"""

import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import FileFormatError, InvalidValueError
from navette.files.untrusted.files import open_regular
from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.pose_graph import GraphEdge
from navette.navigation.slam.scan_graph import KeyScan, ScanGraph
from navette.navigation.slam.scan_points import scan_points

SUFFIX = ".slam"
_VERSION = 1
_MOST_BYTES = 2 << 30
_MOST_KEYS = 1_000_000
_MOST_EDGES = 10_000_000
# Array → dtype and number of dimensions.
_ARRAYS: dict[str, tuple[str, int]] = {
    "version": ("<i8", 0),
    "stamps_ns": ("<i8", 1),
    "poses": ("<f8", 2),
    "sensors": ("<f8", 2),
    "beams": ("<f8", 2),  # angle_min, angle_increment, range_min, range_max
    "counts": ("<i8", 1),
    "ranges": ("<f4", 1),
    "sessions": ("<i8", 1),
    "edges": ("<i8", 2),  # source, target, is_robust
    "measured": ("<f8", 2),
    "information": ("<f8", 3),
}
_WIDTHS = {"poses": 3, "sensors": 3, "beams": 4, "edges": 3, "measured": 3}


def write_graph(path: Path, graph: ScanGraph) -> None:
    """Write a graph; an existing file is replaced when the new one is complete.

    Raises:
        OSError: the file cannot be written.
    """
    scans = [each.scan for each in graph.keys]
    values: dict[str, Any] = {
        "version": np.int64(_VERSION),
        "stamps_ns": np.array([each.stamp_ns for each in graph.keys], np.int64),
        "poses": graph.poses,
        "sensors": np.array([each.base_T_sensor for each in graph.keys]),
        "beams": np.array(
            [(s.angle_min, s.angle_increment, s.range_min, s.range_max) for s in scans]
        ),
        "counts": np.array([len(each.ranges) for each in scans], np.int64),
        "ranges": np.concatenate([np.empty(0, np.float32), *(s.ranges for s in scans)]),
        "sessions": np.array(graph.sessions, np.int64),
        **_edge_arrays(graph.edges),
    }
    part = path.with_name(f".{path.name}.part")
    try:
        with part.open("wb") as file:
            np.savez_compressed(file, **values)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def read_graph(path: Path, params: SlamParams) -> ScanGraph:
    """Read a graph; the points of its scans are computed with ``params``.

    Raises:
        FileFormatError: missing, damaged, too large, or not such a file.
    """
    arrays = _read_arrays(path)
    try:
        _check(arrays)
        return _graph_of(arrays, params)
    except InvalidValueError as error:
        raise FileFormatError(path, str(error)) from None


def _edge_arrays(edges: list[GraphEdge]) -> dict[str, NDArray[Any]]:
    ends = [(each.source, each.target, int(each.is_robust)) for each in edges]
    return {
        "edges": np.array(ends, np.int64).reshape(-1, 3),
        "measured": np.array([each.source_T_target for each in edges]).reshape(-1, 3),
        "information": np.array([each.information for each in edges]).reshape(-1, 3, 3),
    }


def _read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    with open_regular(path) as file:
        try:
            with zipfile.ZipFile(file) as archive:
                sizes = {each.filename: each.file_size for each in archive.infolist()}
            missing = [name for name in _ARRAYS if f"{name}.npy" not in sizes]
            if missing:
                raise FileFormatError(
                    path, f"no map of SLAM: {missing[0]!r} is missing"
                )
            if sum(sizes.values()) > _MOST_BYTES:
                reason = f"{sum(sizes.values())} bytes; at most {_MOST_BYTES}"
                raise FileFormatError(path, reason)
            file.seek(0)
            with np.load(file, allow_pickle=False) as loaded:
                return {name: np.asarray(loaded[name]) for name in _ARRAYS}
        except (zipfile.BadZipFile, ValueError, OSError, EOFError, KeyError,
                NotImplementedError, zlib.error, MemoryError) as error:  # fmt: skip
            if isinstance(error, FileFormatError):
                raise
            reason = f"no map of SLAM, or damaged: {error}"
            raise FileFormatError(path, reason) from None


def _check(arrays: dict[str, NDArray[Any]]) -> None:
    """Raise InvalidValueError unless types, shapes and values belong together."""
    for name, (dtype, dimensions) in _ARRAYS.items():
        array = arrays[name]
        if array.dtype != np.dtype(dtype) or array.ndim != dimensions:
            raise InvalidValueError(
                f"{name}: {array.ndim}-D {array.dtype}; expected {dimensions}-D {dtype}"
            )
        if name in _WIDTHS and array.shape[1] != _WIDTHS[name]:
            raise InvalidValueError(f"{name}: {array.shape[1]} columns")
        if name != "ranges" and not np.isfinite(array).all():
            raise InvalidValueError(f"{name}: not finite")
    if arrays["version"] != _VERSION:
        raise InvalidValueError(f"version {arrays['version']}; expected {_VERSION}")
    keys = len(arrays["stamps_ns"])
    if not 0 < keys <= _MOST_KEYS:
        raise InvalidValueError(f"{keys} scans; expected 1 to {_MOST_KEYS}")
    if any(len(arrays[n]) != keys for n in ("poses", "sensors", "beams", "counts")):
        raise InvalidValueError(f"expected {keys} poses, sensors, beams and counts")
    counts, sessions = arrays["counts"], arrays["sessions"]
    if (counts < 0).any() or counts.sum() != len(arrays["ranges"]):
        raise InvalidValueError(f"{len(arrays['ranges'])} ranges do not fit the counts")
    if (
        not len(sessions)
        or sessions[0] != 0
        or (np.diff(sessions) <= 0).any()
        or sessions[-1] >= keys
    ):
        raise InvalidValueError("sessions: must begin at 0 and increase")
    _check_edges(arrays["edges"], arrays["measured"], arrays["information"], keys)


def _check_edges(
    ends: NDArray[Any], measured: NDArray[Any], information: NDArray[Any], keys: int
) -> None:
    count = len(ends)
    if count > _MOST_EDGES or information.shape != (count, 3, 3):
        raise InvalidValueError(f"{count} edges do not fit {information.shape}")
    if len(measured) != count:
        raise InvalidValueError(f"{count} edges, {len(measured)} measurements")
    if count and (ends[:, :2].min() < 0 or ends[:, :2].max() >= keys):
        raise InvalidValueError(f"an edge ends outside the {keys} scans")
    # Every scan is connected to an earlier one, so that the poses are determined.
    later = np.maximum(ends[:, 0], ends[:, 1])[ends[:, 0] != ends[:, 1]]
    if len(np.unique(later)) != keys - 1:
        raise InvalidValueError("not every scan is connected to an earlier one")
    if count and (np.linalg.eigvalsh(information)[:, 0] < -1e-6).any():
        raise InvalidValueError("the information of an edge is not positive")


def _graph_of(arrays: dict[str, NDArray[Any]], params: SlamParams) -> ScanGraph:
    graph, first = ScanGraph(), 0
    sessions = set(arrays["sessions"].tolist())
    for node, count in enumerate(arrays["counts"].tolist()):
        ranges = np.ascontiguousarray(arrays["ranges"][first : first + count])
        first += count
        scan = PlanarScan(ranges, *map(float, arrays["beams"][node]))
        sensor = Pose2(*map(float, arrays["sensors"][node]))
        points = scan_points(
            scan,
            sensor,
            max_range_m=params.max_range_m,
            spacing_m=params.point_spacing_m,
            max_points=params.max_points,
        )
        key = KeyScan(int(arrays["stamps_ns"][node]), scan, sensor, points)
        pose = Pose2(*map(float, arrays["poses"][node]))
        graph.insert(key, pose, starts_session=node in sessions)
    graph.connect(_edges_of(arrays))
    return graph


def _edges_of(arrays: dict[str, NDArray[Any]]) -> list[GraphEdge]:
    ends, measured = arrays["edges"].tolist(), arrays["measured"].tolist()
    return [
        GraphEdge(source, target, Pose2(*pose), information, bool(is_robust))
        for (source, target, is_robust), pose, information in zip(
            ends, measured, arrays["information"], strict=True
        )
    ]
