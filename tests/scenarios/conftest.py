"""Headless runs as fast as possible, closed at the end of the test."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.sim import Scene

MakeSimulation = Callable[..., Simulation]
# A stuck robot is noticed after 4 s instead of 30 s.
IMPATIENT = """\
planner:
  ros__parameters: {progress_timeout_s: 2.0, max_stuck_replans: 1}
"""


@pytest.fixture
def impatient(tmp_path: Path) -> Path:
    """Parameters with which the robot is soon stuck."""
    file = tmp_path / "impatient.yaml"
    file.write_text(IMPATIENT, encoding="utf-8")
    return file


@pytest.fixture
def simulate() -> Iterator[MakeSimulation]:
    """Makes simulations from keywords of RunOptions, and the parameters of nodes."""
    made: list[Simulation] = []

    def make(
        scene: Scene | None = None,
        parameters: dict[str, dict[str, Any]] | None = None,
        **options: Any,
    ) -> Simulation:
        given = RunOptions(**{"headless": True, "speed": math.inf, **options})
        made.append(Simulation(given, scene=scene, parameters=parameters))
        return made[-1]

    yield make
    for simulation in made:
        simulation.close()
