"""Lifecycle nodes: started like any other."""

from typing import Any

from navette.launch_files.launch_ros.actions.node import Node


class LifecycleNode(Node):
    """A node with a managed lifecycle; its name must be known."""

    def __init__(self, *, name: Any, namespace: Any, **kwargs: Any) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
