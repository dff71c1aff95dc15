"""Is it a node name?"""

from navette.runtime.exceptions import InvalidNodeNameException
from navette.runtime.names import validate_node_name

__all__ = [
    "InvalidNodeNameException",
    "validate_node_name",
]
