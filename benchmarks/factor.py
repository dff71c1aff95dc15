"""Speed of a simulated drive."""

import time

from navette.navigation.stack.simulation import Simulation


def factor(simulation: Simulation) -> float:
    """Run a simulation to its end; return simulated seconds per second of CPU."""
    began = time.process_time()
    simulation.run()
    seconds = time.process_time() - began
    simulated = simulation.summary().sim_time_s
    simulation.close()
    return simulated / seconds
