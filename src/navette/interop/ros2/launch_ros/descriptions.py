"""Navette's ``launch_ros.descriptions``."""

from navette.launch_files.launch_ros.descriptions import (
    ComposableNode,
    Parameter,
    ParameterFile,
    ParameterValue,
)

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
