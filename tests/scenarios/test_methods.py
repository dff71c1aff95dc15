"""Every selectable method drives the robot."""

from pathlib import Path

import pytest

from .conftest import MakeSimulation

# Each method that is not the default, several per drive.
CHOICES = {
    "exponential, max, dijkstra": """
costmap: {ros__parameters: {inflation_method: exponential}}
map_memory: {ros__parameters: {fusion: max}}
planner: {ros__parameters: {method: dijkstra}}
""",
    "log_odds, breadth_first, cross_track_pid": """
map_memory: {ros__parameters: {fusion: log_odds}}
planner: {ros__parameters: {method: breadth_first}}
control: {ros__parameters: {method: cross_track_pid}}
""",
}


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["course", "jackal"])
@pytest.mark.parametrize("choice", CHOICES)
def test_every_method_drives_without_contact(
    simulate: MakeSimulation, tmp_path: Path, robot: str, choice: str
) -> None:
    params = tmp_path / "choice.yaml"
    params.write_text(CHOICES[choice], encoding="utf-8")
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
