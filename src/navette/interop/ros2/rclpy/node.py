"""Nodes."""

from navette.runtime import Node, Parameter
from navette.runtime.node_graph import NodeNameNonExistentError

__all__ = ["Node", "NodeNameNonExistentError", "Parameter"]
