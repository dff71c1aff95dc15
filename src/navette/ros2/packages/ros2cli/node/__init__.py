"""Nodes that tools look at the graph with."""

NODE_NAME_PREFIX = "_ros2cli"

__all__ = ["NODE_NAME_PREFIX"]
