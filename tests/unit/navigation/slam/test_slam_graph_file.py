"""Files of scan graphs."""

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.errors import FileFormatError
from navette.navigation.slam import Slam, SlamParams
from navette.navigation.slam.graph_file import read_graph, write_graph
from slam_office import drive, loop

PARAMS = SlamParams()


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    slam = Slam(PARAMS)
    for step in drive(seed=1, poses=loop(0.5)[:30], beams=90):
        slam.add(step.stamp_ns, step.scan, step.odom_T_base)
    path = tmp_path_factory.mktemp("graph") / "map.slam"
    write_graph(path, slam.graph)
    return path


def test_a_graph_is_read_as_it_was_written(file: Path, tmp_path: Path) -> None:
    graph = read_graph(file, PARAMS)
    assert len(graph) > 10
    assert len(graph.edges) >= len(graph) - 1
    write_graph(tmp_path / "again.slam", graph)
    assert (tmp_path / "again.slam").read_bytes() == file.read_bytes()
    assert [each.name for each in tmp_path.iterdir()] == ["again.slam"]


def changed(file: Path, to: Path, **values: object) -> Path:
    with np.load(file) as loaded:
        arrays = dict(loaded)
    with to.open("wb") as out:
        np.savez_compressed(out, **(arrays | values))  # type: ignore[arg-type]
    return to


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"version": np.int64(7)}, "version 7; expected 1"),
        ({"poses": np.full((3, 3), np.nan)}, "poses: not finite"),
        ({"poses": np.zeros((3, 2))}, "poses: 2 columns"),
        ({"poses": np.zeros((3, 3), np.float32)}, "poses: 2-D float32"),
        ({"counts": np.array([5])}, "poses, sensors, beams and counts"),
        ({"stamps_ns": np.empty(0, np.int64)}, "0 scans"),
        ({"sessions": np.array([3])}, "sessions"),
        ({"edges": np.array([[0, 999, 0]])}, "edges do not fit"),
        ({"version": np.array([{}], object)}, "pickle"),
    ],
)
def test_invalid_arrays_are_refused(
    file: Path, tmp_path: Path, values: dict[str, object], reason: str
) -> None:
    with pytest.raises(FileFormatError, match=reason):
        read_graph(changed(file, tmp_path / "bad.slam", **values), PARAMS)


def test_an_unconnected_scan_is_refused(file: Path, tmp_path: Path) -> None:
    with np.load(file) as loaded:
        edges = loaded["edges"].copy()
    edges[:, 1] = np.minimum(edges[:, 1], 5)
    with pytest.raises(FileFormatError, match="not every scan is connected"):
        read_graph(changed(file, tmp_path / "bad.slam", edges=edges), PARAMS)


@settings(max_examples=60)
@given(st.integers(0, 10**6), st.integers(0, 255))
def test_a_damaged_file_is_refused_or_read(file: Path, at: int, value: int) -> None:
    data = bytearray(file.read_bytes())
    data[at % len(data)] = value
    damaged = file.with_name("damaged.slam")
    damaged.write_bytes(data)
    with suppress(FileFormatError):  # and no other error
        assert len(read_graph(damaged, PARAMS))
