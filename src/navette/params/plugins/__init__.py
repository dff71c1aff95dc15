"""Methods chosen by name: registries, loading of the user's own, and their faults."""

from navette.params.plugins.faults import MethodFaultError, checked_array, own_call
from navette.params.plugins.loading import Method, load_attribute, load_method
from navette.params.plugins.registry import MethodRegistry
from navette.params.plugins.stage_params import method_fields, own_fields, with_methods

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
