"""Parameters of other nodes."""

from navette.runtime import CallbackGroup, Future, Node, Parameter, QoSProfile
from navette.runtime.parameter import parameter_dict_from_yaml_file
from navette.runtime.parameter_client import AsyncParameterClient

__all__ = [
    "AsyncParameterClient",
    "CallbackGroup",
    "Future",
    "Node",
    "Parameter",
    "QoSProfile",
    "parameter_dict_from_yaml_file",
]
