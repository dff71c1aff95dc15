"""Container of composable nodes: loads node classes, runs them on one executor.

Launch files and other programs load nodes by ROS 2's composition services.
"""

from navette import runtime
from navette.ros2.launch.components import ComponentManager
from navette.runtime import Executor, Node
from navette.runtime.context import get_default_context


def main() -> None:
    """Serve requests until the shutdown."""
    runtime.init()
    context = get_default_context()
    executor = Executor(context=context)
    node = Node("component_container")
    executor.add_node(node)
    ComponentManager(node, executor)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass  # ends the container
    finally:
        runtime.try_shutdown()
