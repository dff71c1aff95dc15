"""The simulated robot: worlds, physics and sensors on MuJoCo."""

from navette.sim.builder import World
from navette.sim.clearance import Clearance
from navette.sim.contacts import ContactEpisode
from navette.sim.imu import ImuReading
from navette.sim.library import (
    Robot,
    identify_robot,
    load_robot,
    load_world,
    robot_names,
    world_names,
)
from navette.sim.lidar import Scan
from navette.sim.params import SimParams
from navette.sim.profile import derive_parameters, footprint_of
from navette.sim.robot_state import Motion
from navette.sim.scene import Model, Scene
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
