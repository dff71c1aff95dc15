"""Methods chosen by name: registries, loading of the user's own, and their faults."""

from navette.plugins.faults import MethodFaultError, checked_array, own_call
from navette.plugins.loading import Method, load_attribute, load_method
from navette.plugins.registry import MethodRegistry
from navette.plugins.stage_params import method_fields, own_fields, with_methods

__all__ = [
    "Method",
    "MethodFaultError",
    "MethodRegistry",
    "checked_array",
    "load_attribute",
    "load_method",
    "method_fields",
    "own_call",
    "own_fields",
    "with_methods",
]
