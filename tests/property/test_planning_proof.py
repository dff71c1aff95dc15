"""The proof that no path exists, against an exhaustive search on small maps."""

import numpy as np
import pytest
from reachability import WorldGeometry, connected

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.planning.body_space import BodySpace

BODY = Footprint(((0.35, 0.15), (-0.2, 0.15), (-0.2, -0.15), (0.35, -0.15)))
SPEC = GridSpec(0.05, 50, 50)
START = Pose2(0.4, 0.4, 0.6)
# A point as a convex outline, and clearance for the way between exhaustive poses.
_POINT = np.array([(0.0, 0.0), (1e-6, 0.0), (0.0, 1e-6)])
_BETWEEN_M = 0.025


def random_map(seed: int) -> np.ndarray:
    """Walls with gaps of any width, and single cells; free around the start."""
    rng = np.random.default_rng(seed)
    lethal = rng.random(SPEC.shape) < 0.004
    for line in rng.integers(16, 46, 2):
        gap, at = rng.integers(5, 12), rng.integers(0, 40)
        wall = np.ones(50, np.bool_)
        wall[at : at + gap] = False
        if rng.random() < 0.5:
            lethal[line] |= wall
        else:
            lethal[:, line] |= wall
    lethal[:16, :16] = False
    lethal[[0, -1]] = lethal[:, [0, -1]] = True
    return lethal


def exhaustive(lethal: np.ndarray, margin_m: float | None) -> np.ndarray:
    """Return (H, W) the cells that a flood over fine poses reaches with a margin.

    None: less than touching, by as much as a pose may move within its cell.
    """
    points = SPEC.centers_of(np.argwhere(lethal))
    start = np.array([(START.x, START.y)])
    outline = np.array(BODY.vertices)
    world = WorldGeometry.around([p + _POINT for p in points], outline, start, 0.1)
    opened = world.open_poses(-world.slack_m if margin_m is None else margin_m)
    poses = np.argwhere(connected(opened, world.index_of(START), sideways=True))
    cells = np.zeros(SPEC.shape, np.bool_)
    for x, y in np.unique(world.spec.centers_of(poses[:, 1:]), axis=0).tolist():
        row, column = SPEC.cell_of(x, y)
        if SPEC.contains(row, column):
            cells[row, column] = True
    return cells


def reached(lethal: np.ndarray, margin_m: float | None) -> np.ndarray:
    space = BodySpace(lethal, SPEC, BODY, START, margin_m=margin_m)
    return space.reached_from(np.array([space.start]))


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_what_the_proof_excludes_cannot_be_reached(seed: int) -> None:
    lethal = random_map(seed)
    possible = reached(lethal, None)
    assert not (exhaustive(lethal, _BETWEEN_M) & ~possible).any()


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("margin_m", [0.03])
def test_what_is_reached_with_a_margin_can_be_reached(
    seed: int, margin_m: float
) -> None:
    lethal = random_map(seed)
    certain = reached(lethal, margin_m)
    assert not (certain & ~exhaustive(lethal, None)).any()
    wider = reached(lethal, margin_m + 0.05)
    assert not (wider & ~certain).any()
