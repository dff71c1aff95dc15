"""Navette's ``launch_ros.parameter_descriptions``."""

from navette.launch_files.launch_ros.parameter_descriptions import (
    Parameter,
    ParameterFile,
    ParameterValue,
)

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]
