"""Speed of a simulated drive."""

import gc
import time

from navette.navigation.stack.simulation import Simulation


def factor(simulation: Simulation) -> float:
    """Run a simulation to its end; return simulated seconds per second of CPU.

    The context of a first run in this process exempts its objects from garbage
    collection. A later one gets the same: users run one.
    """
    gc.collect()
    gc.freeze()
    began = time.process_time()
    simulation.run()
    seconds = time.process_time() - began
    simulated = simulation.summary().sim_time_s
    simulation.close()
    return simulated / seconds
