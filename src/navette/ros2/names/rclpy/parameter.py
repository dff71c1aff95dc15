"""Parameters."""

from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.msgs.rcl_interfaces.msg import ParameterType, ParameterValue
from navette.runtime.parameter import (
    PARAMETER_SEPARATOR_STRING,
    AllowableParameterValue,
    Parameter,
    get_parameter_value,
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)

__all__ = [
    "AllowableParameterValue",
    "PARAMETER_SEPARATOR_STRING",
    "Parameter",
    "ParameterMsg",
    "ParameterType",
    "ParameterValue",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_value_to_python",
]
