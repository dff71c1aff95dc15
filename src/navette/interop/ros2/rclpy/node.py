"""Nodes."""

from navette.runtime import Node, Parameter

__all__ = ["Node", "Parameter"]
