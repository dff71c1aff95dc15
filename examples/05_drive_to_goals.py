"""The whole stack: a simulated robot drives to two goals without a map.

Prints::

    (6.2, -3.4): reached
    (8.2, 7.8): reached
    0 contacts
"""

import math

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

options = RunOptions(
    world="arena",
    robot="jackal",
    goals=((6.2, -3.4), (8.2, 7.8)),
    headless=True,  # False: watch it on http://127.0.0.1:8765
    speed=math.inf,  # 1.0: real time
    seed=1,
)
simulation = Simulation(options)
simulation.run()
summary = simulation.summary()
simulation.close()

for outcome in summary.goals:
    print(f"{outcome.goal}: {outcome.result}")
print(summary.contacts, "contacts")
