"""The replayed stages: inputs of each, and tolerances of its results.

The golden bags hold inputs, parameters and results of one drive of our own simulator,
each a bag for ``navette bag replay BAG --node STAGE --compare BAG``. The outputs of a
stage for the recorded inputs are compared with the recorded outputs: exactly, except
for values that another processor or NumPy release may round differently.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from navette.bags import open_bag
from navette.bags.compare import Comparison, Tolerances, compare
from navette.navigation.stack.replay import Replay
from navette.navigation.stack.stage_classes import node_class
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
        outputs=("/costmap", "/costmap/points"),
        duration_s=10.0,
        # A beam along an edge between two cells may fall on either side. Points are
        # bytes of float32: the last one may be rounded differently.
        tolerances=("/costmap.data=0:0.5%", "/costmap/points.data=1:1%"),
    ),
    Stage(
        "map_memory",
        inputs=("/costmap/points", "/costmap", "/odom/filtered", "/tf_static"),
        outputs=("/map", "/map/points"),
        duration_s=8.0,
        tolerances=("/map.data=0:0.5%", "/map/points.data=1:1%"),
    ),
    Stage(
        "planner",
        inputs=(
            "/map/points",
            "/map",
            "/odom/filtered",
            "/goal_point",
            "/tf_static",
        ),
        outputs=("/path", "/planner/status"),
        duration_s=15.0,
        tolerances=("/path.poses=1e-6",),
    ),
    Stage(
        "control",
        inputs=(
            "/path",
            "/odom/filtered",
            "/costmap/points",
            "/costmap",
            "/map/points",
            "/map",
            "/planner/status",
            "/tf_static",
        ),
        outputs=("/cmd_vel_nav", "/control/status"),
        duration_s=7.0,
        tolerances=("/cmd_vel_nav=1e-6",),
    ),
)


def replay(
    stage: Stage,
    record: Path,
    *,
    make: Callable[[Context], Node] | None = None,
    arguments: tuple[str, ...] = (),
) -> Comparison:
    """Replay the golden bag through the stage; compare its outputs."""
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
