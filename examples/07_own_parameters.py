"""Select other methods and a lower speed with a ROS 2 parameter file.

Other parameters keep the values of the robot's own file.

Prints::

    planner: dijkstra, control: cross_track_pid at 0.6 m/s
    reached
"""

import math
import tempfile
from pathlib import Path

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

PARAMETERS = """
planner:
  ros__parameters:
    method: dijkstra
control:
  ros__parameters:
    method: cross_track_pid
    cruise_speed_mps: 0.6
"""

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "mine.yaml"
    file.write_text(PARAMETERS)
    options = RunOptions(
        robot="jackal",
        goals=((-2.0, -7.0),),
        headless=True,
        speed=math.inf,
        params_files=(file,),
    )
    simulation = Simulation(options)

planner, control = simulation.stack.planner.params, simulation.stack.control.params
print(
    f"planner: {planner.method}, control: {control.method} "
    f"at {control.cruise_speed_mps} m/s"
)
simulation.run()
print(simulation.summary().goals[0].result)
simulation.close()
