"""Search over position and heading: A* on a lattice of short feasible moves.

State-lattice planning (Pivtoraiko and Kelly 2005) in the manner of hybrid A*
(Dolgov et al. 2008): poses keep their exact position, and one pose is kept per bin of
position and heading. The body is checked against the distance field at every sample of
every move. The cost to go of the grid (obstacles and costs, without headings) is the
heuristic.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2, wrap_angles
from navette.navigation.grids import (
    CellWindow,
    DistanceGrid,
    DistanceLevels,
    GridSpec,
    ObstacleGrid,
    Outline,
    distance_levels,
    grid_frame,
    level_metres,
    make_body,
    make_obstacles,
    sparse_zeros,
)
from navette.navigation.planning.bucket_queue import BucketQueue, new_pool
from navette.navigation.planning.dijkstra import Guide
from navette.navigation.planning.lattice_kernels import (
    BUCKETS,
    HEADING,
    MOVE,
    PARENT,
    SHIFT,
    LatticeScene,
    MoveTable,
    Tree,
    grow,
)
from navette.navigation.planning.lattice_motions import Motions
from navette.navigation.planning.traversal import STRAIGHT

_UNSEEN_REACH_M = 10.0  # around the start, for distances to unseen cells
_LARGE_BYTES = 1 << 20  # a search reaches few poses of its budget, and few bins


@dataclass(frozen=True)
class LatticeWorld:
    """Map and body of a search.

    Attributes:
        distances: (H, W) to the nearest obstacle.
        factors: (256,) float32, cost of a metre by that of its cell (1 = free).
        guide: cost to go to the goal.
        spec: geometry of these grids.
        body: (K, 3) points and disc radii of the body, base frame.
        margin_m: clearance that the body keeps.
        comfort_m: clearance, above the margin, beyond which more has no value.
        outside_m: distance to obstacles assumed outside the grid.
        obstacles: the lethal cells, for exact clearances in tight places.
        outline: outline of the body.
        unseen: (H, W) uint8, 1 = cells that the body does not enter in reverse.
    """

    distances: DistanceLevels
    factors: NDArray[np.float32]
    guide: Guide
    spec: GridSpec
    body: NDArray[np.float64]
    margin_m: float
    comfort_m: float
    outside_m: float
    obstacles: ObstacleGrid
    outline: Outline
    unseen: NDArray[np.uint8]


@dataclass(frozen=True)
class LatticeGoal:
    """Any pose about (x, y) within the tolerance; nearer is cheaper.

    ``yaw`` None: any heading. ``pull`` is the cost of a metre from the exact goal, in
    metres driven.
    """

    x: float
    y: float
    tolerance_m: float
    yaw: float | None = None
    yaw_tolerance: float = 0.2
    pull: float = 3.0


@dataclass(frozen=True)
class LatticeResult:
    """Poses (N, 3) from the start on; ``expansions`` is the number of poses expanded.

    ``poses`` is empty if no path was found; ``exhausted`` is then True if the budget
    ran out, and False if no poses were left to try.
    """

    poses: NDArray[np.float64]
    expansions: int
    exhausted: bool


def search(
    world: LatticeWorld,
    start: Pose2,
    goal: LatticeGoal,
    motions: Motions,
    *,
    max_expansions: int = 40_000,
) -> LatticeResult:
    """Search for drivable poses from ``start`` to the goal within the budget.

    From a start with less clearance than the margin, the path may continue along poses
    with no less clearance than the start; once the margin is reached it applies.

    Raises:
        InvalidValueError: the start lies outside the grid.
    """
    if not world.spec.contains(*world.spec.cell_of(start.x, start.y)):
        raise InvalidValueError(f"start {start}: outside the grid {world.spec}")
    tree = _new_tree(world.spec, motions, max_expansions)
    per_metre = STRAIGHT / world.spec.resolution
    node, expanded = grow(
        _scene(world, start),
        _move_table(motions, per_metre),
        tree,
        (float(start.x), float(start.y), float(start.yaw)),
        _goal_array(goal, per_metre),
        new_pool(),
        max_expansions,
    )
    if node < 0:
        return LatticeResult(np.empty((0, 3)), expanded, expanded >= max_expansions)
    return LatticeResult(_retrace(tree, node, start.yaw, motions), expanded, False)


def _scene(world: LatticeWorld, start: Pose2) -> LatticeScene:
    spec = world.spec
    # Only the exact check covers what is farther away.
    reach = math.ceil(_UNSEEN_REACH_M / spec.resolution)
    near = CellWindow.around(spec, np.array([(start.x, start.y)]), reach)
    unseen_m = level_metres(spec.resolution, 2 * world.outline.radius_m)
    levels = distance_levels(world.unseen[near.slices], unseen_m)
    return LatticeScene(
        DistanceGrid(world.distances, grid_frame(spec), float(world.outside_m)),
        world.factors,
        world.guide,
        make_body(world.body),
        world.obstacles,
        world.outline,
        make_obstacles(world.unseen, spec),
        DistanceGrid(
            DistanceLevels(levels, unseen_m), grid_frame(near.spec_in(spec)), 0.0
        ),
        float(world.margin_m),
        float(world.comfort_m),
    )


def _move_table(motions: Motions, per_metre: float) -> MoveTable:
    return MoveTable(
        motions.offsets,
        motions.sample_counts,
        motions.costs_m * per_metre,
        motions.cusp_cost_m * per_metre,
        motions.directions,
        motions.turns,
        motions.headings,
    )


def _new_tree(spec: GridSpec, motions: Motions, max_expansions: int) -> Tree:
    bin_cells = max(1.0, motions.bin_m / spec.resolution)
    bins_wide = int(spec.width / bin_cells) + 1
    bins_high = int(spec.height / bin_cells) + 1
    room = len(motions.moves) * max_expansions + 1
    bins = bins_high * bins_wide * motions.headings
    return Tree(
        sparse_zeros((room, 2), np.float64, large_bytes=_LARGE_BYTES),
        sparse_zeros((room, 5), np.int32, large_bytes=_LARGE_BYTES),
        sparse_zeros((bins,), np.int32, large_bytes=_LARGE_BYTES),
        bin_cells,
        bins_wide,
        BucketQueue.empty(BUCKETS, SHIFT),
    )


def _goal_array(goal: LatticeGoal, per_metre: float) -> NDArray[np.float64]:
    yaw = math.nan if goal.yaw is None else goal.yaw
    pull = goal.pull * per_metre
    where = goal.x, goal.y, goal.tolerance_m
    return np.array([*where, yaw, goal.yaw_tolerance, pull, per_metre])


def _retrace(
    tree: Tree, last: int, start_yaw: float, motions: Motions
) -> NDArray[np.float64]:
    """Return every sample (N, 3) of every move from the root to ``last``."""
    chain = [last]
    while tree.links[chain[-1], PARENT] >= 0:
        chain.append(int(tree.links[chain[-1], PARENT]))
    chain.reverse()
    pieces = [np.array([[*tree.position[0], start_yaw]])]
    for parent, child in itertools.pairwise(chain):
        move = tree.links[child, MOVE]
        yaw = start_yaw + tree.links[parent, HEADING] * motions.heading_step
        base = Pose2(tree.position[parent, 0], tree.position[parent, 1], yaw)
        steps = motions.offsets[move, : motions.sample_counts[move]]
        pieces.append(np.column_stack([base.apply(steps[:, :2]), yaw + steps[:, 2]]))
    poses = np.concatenate(pieces)
    poses[:, 2] = wrap_angles(poses[:, 2])
    return poses
