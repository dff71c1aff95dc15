"""Base of the stages: inputs, outputs, parameters, robot pose and status."""

from navette.runtime.stage.params import declare_params
from navette.runtime.stage.stage_node import Input, Output, StageNode

__all__ = ["Input", "Output", "StageNode", "declare_params"]
