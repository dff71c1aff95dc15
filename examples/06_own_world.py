"""Build a world in a few lines: a slalom between three columns.

Prints::

    reached with 0 contacts
    clearance above 0.1 m: True
"""

import math

from navette.geometry import Pose2
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.sim import World

slalom = World("slalom").add_walls((14.0, 5.0))
for x, y in ((-3.0, 1.0), (0.0, -1.0), (3.0, 1.0)):
    slalom.add_cylinder((x, y), 0.4).add_box((x, 1.9 * y), (0.3, 1.2))

options = RunOptions(
    robot="jackal",
    start=Pose2(-6.0, 0.0, 0.0),
    goals=((6.0, 0.0),),
    headless=True,
    speed=math.inf,
)
simulation = Simulation(options, scene=slalom.scene())
simulation.run()
summary = simulation.summary()
simulation.close()

(outcome,) = summary.goals
print(f"{outcome.result} with {summary.contacts} contacts")
print("clearance above 0.1 m:", summary.min_clearance_m > 0.1)
