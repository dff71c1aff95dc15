"""What Navette's own nodes share: declared inputs and outputs, parameters, the pose."""

from navette.runtime.stage.params import declare_params
from navette.runtime.stage.stage_node import Input, Output, StageNode

__all__ = ["Input", "Output", "StageNode", "declare_params"]
