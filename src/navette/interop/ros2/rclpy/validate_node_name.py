"""Is it a node name?"""

from navette.runtime.names import validate_node_name

__all__ = ["validate_node_name"]
