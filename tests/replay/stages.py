"""The stages that are replayed: what feeds each, and how far its results may be off.

The golden bags hold inputs, parameters and results of one drive of our own simulator,
each a bag for ``navette bag replay BAG --node STAGE --compare BAG``. What a stage
says when it is fed the same again is compared with what it said then: exactly, except
for what another processor or another release of NumPy may round otherwise.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from navette.bags import open_bag
from navette.bags.compare import Comparison, Tolerances, compare
from navette.navigation.stack.replay import Replay
from navette.navigation.stack.stack import node_class
from navette.runtime import Context, Node

FOLDER = Path(__file__).parent / "golden"


@dataclass(frozen=True)
class Stage:
    """A stage with its golden bag."""

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    duration_s: float
    tolerances: tuple[str, ...]

    @property
    def bag(self) -> Path:
        return FOLDER / f"{self.name}.mcap"


STAGES = (
    Stage(
        "costmap",
        inputs=("/lidar",),
        outputs=("/costmap",),
        duration_s=10.0,
        # A beam along an edge between two cells may fall on either side.
        tolerances=("/costmap.data=0:0.5%",),
    ),
    Stage(
        "map_memory",
        inputs=("/costmap", "/odom/filtered", "/tf_static"),
        outputs=("/map",),
        duration_s=10.0,
        tolerances=("/map.data=0:0.5%",),
    ),
    Stage(
        "planner",
        inputs=("/map", "/odom/filtered", "/goal_point", "/tf_static"),
        outputs=("/path", "/planner/status"),
        duration_s=15.0,
        tolerances=("/path.poses=1e-6",),
    ),
    Stage(
        "control",
        inputs=(
            "/path",
            "/odom/filtered",
            "/costmap",
            "/planner/status",
            "/tf_static",
        ),
        outputs=("/cmd_vel", "/control/status"),
        duration_s=10.0,
        tolerances=("/cmd_vel=1e-6",),
    ),
)


def replay(
    stage: Stage,
    record: Path,
    *,
    make: Callable[[Context], Node] | None = None,
    arguments: tuple[str, ...] = (),
) -> Comparison:
    """Feed the stage with its golden bag; what differs from the results in it."""
    kind: Callable[..., Node] = node_class(stage.name)
    with open_bag(stage.bag) as source:
        replayed = Replay(
            source,
            [make or (lambda context: kind(context=context))],
            record=record,
            arguments=["--ros-args", *arguments],
        )
        try:
            replayed.run()
        finally:
            replayed.close()
        with open_bag(record) as got:
            return compare(
                source,
                got,
                topics=stage.outputs,
                tolerances=Tolerances.parse(stage.tolerances),
            )
