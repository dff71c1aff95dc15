"""Every selectable method drives the robot."""

from pathlib import Path

import pytest

from .conftest import MakeSimulation

CHOICES = [
    ("costmap", "inflation_method", "exponential"),
    ("map_memory", "fusion", "max"),
    ("map_memory", "fusion", "log_odds"),
    ("planner", "method", "dijkstra"),
    ("planner", "method", "breadth_first"),
    ("control", "method", "cross_track_pid"),
]


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["course", "jackal"])
@pytest.mark.parametrize(("node", "parameter", "value"), CHOICES)
def test_every_method_drives_without_contact(
    simulate: MakeSimulation,
    tmp_path: Path,
    robot: str,
    node: str,
    parameter: str,
    value: str,
) -> None:
    params = tmp_path / "choice.yaml"
    params.write_text(
        f"{node}:\n  ros__parameters:\n    {parameter}: {value}\n", encoding="utf-8"
    )
    simulation = simulate(
        world="course",
        robot=robot,
        goals=((-6.0, -12.0), (-2.0, -12.0)),
        params_files=(params,),
        max_time_s=90.0,
    )
    simulation.run()
    summary = simulation.summary()
    assert [goal.result for goal in summary.goals] == ["reached", "reached"]
    assert summary.contacts == 0
