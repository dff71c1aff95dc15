"""Compile a part of the kernels that a drive needs, in a process of its own.

    python -m navette.navigation.stack.kernel_part PART [later]

The machine code is stored and the part noted as prepared; the program that starts this
process then loads it. PART is ``planning``, ``locating`` for SLAM, AMCL, the filter of
their odometry and exploration, or ``driving`` for all the rest and a short drive.
``later`` leaves the processor to other processes.
"""

import os
import sys
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import navette
from navette.files.kernels import note_prepared
from navette.geometry import Pose2
from navette.navigation.grids import FREE, LETHAL, UNKNOWN, CellWindow, GridSpec
from navette.navigation.stack.options import RunOptions

LOCATING = "locating"
PARTS = ("planning", "driving", LOCATING)
LATER = "later"
# Simulated time after which the robot moves and every node has been called.
_DRIVE_S = 3.0


def mark_of(part: str) -> str:
    """Return the name under which a part of this version is noted as prepared."""
    return f"{navette.__version__}-{part}"


def compile_planning() -> None:
    """Compile the kernels of the planner and of keep-out zones."""
    from navette.navigation.grids.zones import KeepOutZones

    _make("planner")
    cells, spec = np.zeros((2, 2), np.int8), GridSpec(1.0, 2, 2)
    cells[0] = 100
    KeepOutZones(cells, spec).mark(cells, spec, CellWindow.whole(cells.shape))


def compile_driving() -> None:
    """Compile the kernels of the other nodes, then drive."""
    for name in ("costmap", "map_memory", "tracking", "control", "behaviors"):
        _make(name)
    from navette.navigation.stack import demo_goals
    from navette.navigation.stack.simulation import Simulation

    simulation = Simulation(
        RunOptions(
            world="arena",
            goals=demo_goals(),
            headless=True,
            speed=float("inf"),
            max_time_s=_DRIVE_S,
        )
    )
    try:
        simulation.run()
    finally:
        simulation.close()


def compile_locating() -> None:
    """Compile the kernels of SLAM, AMCL, the filter of odometry and exploration."""
    from navette.navigation.slam.warm_up import warm_up

    warm_up()
    _make("ekf", gps0="fix")
    # A room with one side open.
    spec = GridSpec(0.1, 80, 80, Pose2(0.0, 0.0, 0.0))
    cells = np.full(spec.shape, UNKNOWN, np.int8)
    cells[9:61, 9:60] = LETHAL
    cells[10:60, 10:60] = FREE
    _explore(cells, spec)
    _localize(cells, spec)


def _explore(cells: NDArray[np.int8], spec: GridSpec) -> None:
    """Find the frontiers of a map (H, W)."""
    from navette.navigation.missions.explore.frontiers import (
        FrontierParams,
        FrontierSearch,
    )

    search = FrontierSearch.of(cells, spec, FrontierParams())
    if search.explore((3.0, 3.0)).best is None:
        raise RuntimeError("no frontier: kernels of exploration were not called")


def _localize(cells: NDArray[np.int8], spec: GridSpec) -> None:
    """Search a map (H, W) for a robot that sees its obstacles from the corner."""
    from navette.navigation.localization.amcl import LikelihoodField
    from navette.navigation.localization.amcl.global_search import search_map

    field = LikelihoodField.of(cells, spec, sigma=0.2, random=0.1, reach_m=2.0)
    points = spec.centers_of(np.argwhere(cells == LETHAL))[::4]
    poses = search_map(field, points).poses
    field.share_within(poses[0], points, 0.1)
    field.agreement(poses, points, 0.1)


def _make(name: str, **parameters: str) -> None:
    """Create a node, which compiles its kernels, and destroy it."""
    from navette.navigation.stack.stage_classes import node_class
    from navette.runtime import (
        Context,
        LoggingSeverity,
        Node,
        Parameter,
        VirtualClock,
    )

    context = Context(clock=VirtualClock())
    context.init(args=[], console_level=LoggingSeverity.FATAL)
    try:
        kind: Callable[..., Node] = node_class(name)
        overrides: list[Parameter[str]] = [
            Parameter(key, value=value) for key, value in parameters.items()
        ]
        kind(context=context, parameter_overrides=overrides)
    finally:
        context.try_shutdown()


_COMPILE: dict[str, Callable[[], None]] = dict(
    zip(PARTS, (compile_planning, compile_driving, compile_locating), strict=True)
)

if __name__ == "__main__":
    if sys.argv[2:] == [LATER] and hasattr(os, "nice"):
        os.nice(19)
    _COMPILE[sys.argv[1]]()
    note_prepared(mark_of(sys.argv[1]))
