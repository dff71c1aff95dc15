"""The world of a trial from above, for the report."""

import numpy as np
from numpy.typing import NDArray

from navette.navigation.bench.run import options_of
from navette.navigation.bench.trial import Trial
from navette.navigation.stack.scene import resolve_scene
from navette.sim import Simulator


def obstacle_outlines(trial: Trial) -> list[NDArray[np.float64]]:
    """Return the outline (N, 2) of each obstacle (m, map) at the start of the trial.

    Raises:
        NavetteError: invalid world or robot.
    """
    resolved = resolve_scene(options_of(trial))
    return Simulator(resolved.scene, start=trial.start).outlines()
