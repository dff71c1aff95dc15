"""People who move: the robot yields, passes or overtakes, without contact."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import LETHAL, grid_from_message
from navette.sim import World, load_world

from .conftest import MakeSimulation

START = Pose2(0.0, 0.0, 0.0)
GOAL = (9.0, 0.0)

# At x = 4 the walker is on the robot's path when the robot is near, at either speed.
CROSSING = """<sdf version="1.9"><world name="crossing"><actor name="walker"><script>
<loop>false</loop><trajectory id="0" type="walk">
<waypoint><time>0</time><pose>4 -{away} 0 0 0 1.57</pose></waypoint>
<waypoint><time>10</time><pose>4 {away} 0 0 0 1.57</pose></waypoint>
</trajectory></script></actor></world></sdf>"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robot", "method", "away"),
    [("jackal", "mppi", 10), ("jackal", "pure_pursuit", 8), ("course", "", 6)],
)
def test_a_person_who_crosses_is_not_touched(
    simulate: MakeSimulation, tmp_path: Path, robot: str, method: str, away: int
) -> None:
    file = tmp_path / "crossing.sdf"
    file.write_text(CROSSING.format(away=away), encoding="utf-8")
    own = {"control": {"method": method}} if method else {}
    simulation = simulate(
        scene=load_world(file),
        parameters=own,
        robot=robot,
        start=START,
        goals=(GOAL,),
        max_time_s=60.0,
    )
    simulation.run()
    summary = simulation.summary()
    assert [goal.result for goal in summary.goals] == ["reached"]
    assert summary.contacts == 0


@pytest.mark.slow
def test_a_slow_walker_ahead_is_overtaken_and_leaves_no_trail(
    simulate: MakeSimulation,
) -> None:
    world = World().add_walls((30, 12))
    world.add_actor([(0, 2.5, 0), (40, 12.5, 0)], loop=False)
    simulation = simulate(
        scene=world.scene(),
        robot="jackal",
        start=START,
        goals=(GOAL,),
        max_time_s=30.0,
    )
    simulation.run()
    summary = simulation.summary()
    assert [goal.result for goal in summary.goals] == ["reached"]
    assert summary.contacts == 0
    assert summary.sim_time_s < 20.0  # the walker takes 26 s
    message = simulation.stack.map_memory._published  # type: ignore[attr-defined]
    cells, spec = grid_from_message(message)
    behind = [spec.cell_of(x, 0.0) for x in np.arange(2.0, 4.5, 0.05)]
    assert not any(cells[cell] >= LETHAL for cell in behind)


def test_a_wrong_actor_ends_the_command_with_file_and_line(
    tmp_path: Path,
) -> None:
    file = tmp_path / "wrong.sdf"
    text = CROSSING.format(away=6).replace("<time>10</time>", "<time>-1</time>")
    file.write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "navette", "sim", str(file), "--headless"]
    done = subprocess.run(
        [*command, "--goal", "9,0"], capture_output=True, text=True, check=False
    )
    assert done.returncode != 0
    assert "wrong.sdf:4" in done.stderr
    assert "<time> is -1 s; must be >= 0" in done.stderr
