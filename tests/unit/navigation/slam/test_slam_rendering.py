"""Drawing of the map of a growing graph."""

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.slam import SlamParams, rendering
from navette.navigation.slam.rendering import MapRenderer, MapScan, render
from slam_office import drive, loop

PARAMS = SlamParams()
SCANS = [
    MapScan(step.scan, pose)
    for step, pose in zip(
        drive(seed=1, poses=loop(0.5)[:40]), loop(0.5)[:40], strict=True
    )
]


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[MapScan]:
    """Return the scans that are drawn, in order."""
    scans: list[MapScan] = []
    add = rendering.add_scan

    def add_scan(field, spec, placed, params) -> None:
        scans.append(placed)
        add(field, spec, placed, params)

    monkeypatch.setattr(rendering, "add_scan", add_scan)
    return scans


def test_only_new_scans_are_drawn(drawn: list[MapScan]) -> None:
    renderer = MapRenderer(PARAMS)
    renderer.render(SCANS[:5])
    cells, spec = renderer.render(SCANS[:8])
    assert [id(each) for each in drawn] == [id(each) for each in SCANS[:8]]
    whole, smaller = render(SCANS[:8], PARAMS)
    row, column = spec.cell_of(*smaller.center_of(0, 0))
    inside = cells[row : row + smaller.height, column : column + smaller.width]
    # Coordinates from another corner are rounded to other cells here and there.
    assert np.mean(inside != whole) < 0.005


def test_a_map_with_coarser_cells_is_not_drawn_again(
    drawn: list[MapScan], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rendering, "_MOST_CELLS", 100_000)
    renderer = MapRenderer(PARAMS)
    _, spec = renderer.render(SCANS[:20])
    assert spec.resolution > PARAMS.resolution_m
    assert spec.width * spec.height <= 100_000
    renderer.render(SCANS[:22])
    renderer.render(SCANS[:22])
    assert len(drawn) == 22


def test_a_scan_beyond_the_drawn_map_is_drawn(drawn: list[MapScan]) -> None:
    renderer = MapRenderer(PARAMS)
    _, before = renderer.render(SCANS[:2])
    far = SCANS[2]._replace(map_T_sensor=Pose2(300.0, 0.0, 0.0))
    cells, spec = renderer.render([*SCANS[:2], far])
    assert spec.width > before.width
    assert cells[spec.cell_of(300.0, 0.0)] == 0
    assert len(drawn) == 5


def test_moved_scans_are_drawn_again(drawn: list[MapScan]) -> None:
    renderer = MapRenderer(PARAMS)
    renderer.render(SCANS[:3])
    moved = [each._replace(map_T_sensor=Pose2(0.1, 0.0, 0.0) @ each.map_T_sensor)
             for each in SCANS[:3]]  # fmt: skip
    cells, spec = renderer.render(moved)
    expected, other = MapRenderer(PARAMS).render(moved)
    assert spec == other
    np.testing.assert_array_equal(cells, expected)


def test_without_scans_the_map_is_unknown() -> None:
    cells, _ = MapRenderer(PARAMS).render([])
    assert (cells == -1).all()
