"""The simulated robot: worlds, physics and sensors on MuJoCo.

MuJoCo is imported with the first name that needs it: reading worlds and robots, as each
stage does for its robot's parameters, works without it.
"""

from typing import TYPE_CHECKING, Any

from navette.sim.builder import World
from navette.sim.library import (
    Robot,
    identify_robot,
    load_robot,
    load_world,
    robot_names,
    world_names,
)
from navette.sim.params import SimParams
from navette.sim.profile import derive_parameters, footprint_of
from navette.sim.scene import Model, Scene

if TYPE_CHECKING:
    from navette.sim.clearance import Clearance
    from navette.sim.contacts import ContactEpisode
    from navette.sim.imu import ImuReading
    from navette.sim.lidar import Scan
    from navette.sim.robot_state import Motion
    from navette.sim.simulator import Simulator

__all__ = [
    # worlds and robots
    "Model",
    "Robot",
    "Scene",
    "World",
    "identify_robot",
    "load_robot",
    "load_world",
    "robot_names",
    "world_names",
    # parameters
    "SimParams",
    "derive_parameters",
    "footprint_of",
    # simulation
    "Clearance",
    "ContactEpisode",
    "ImuReading",
    "Motion",
    "Scan",
    "Simulator",
]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'navette.sim' has no attribute {name!r}")
    from navette.sim.clearance import Clearance
    from navette.sim.contacts import ContactEpisode
    from navette.sim.imu import ImuReading
    from navette.sim.lidar import Scan
    from navette.sim.robot_state import Motion
    from navette.sim.simulator import Simulator

    loaded = (Clearance, ContactEpisode, ImuReading, Motion, Scan, Simulator)
    globals().update({each.__name__: each for each in loaded})
    return globals()[name]
