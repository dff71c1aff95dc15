"""Is it a parameter's name?"""

from navette.runtime.exceptions import InvalidParameterException
from navette.runtime.parameter import validate_parameter_name

__all__ = [
    "InvalidParameterException",
    "validate_parameter_name",
]
