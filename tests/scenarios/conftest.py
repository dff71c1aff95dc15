"""Headless runs as fast as possible, closed at the end of the test."""

import math
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.sim import Scene

MakeSimulation = Callable[..., Simulation]


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
