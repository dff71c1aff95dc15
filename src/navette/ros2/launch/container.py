"""The container of composable nodes: loads node classes, runs them on one loop.

A program like any other. It serves ROS 2's composition services, and reads what its
launch file wants loaded from its standard input, a line of JSON each:
``{"package": …, "plugin": …, "arguments": [ROS arguments]}``.
"""

import json
import sys
import threading
from collections.abc import Iterator
from functools import partial
from typing import Any

from navette import runtime
from navette.ros2.launch.components import ComponentManager, arguments_of_words
from navette.ros2.launch.programs import program_input
from navette.runtime import Executor, Node
from navette.runtime.context import get_default_context


def main() -> None:
    """Load what is asked for, until the end."""
    runtime.init()
    context = get_default_context()
    executor = Executor(context=context)
    node = Node("component_container")
    executor.add_node(node)
    manager = ComponentManager(node, executor)
    threading.Thread(target=_listen, args=(executor, manager), daemon=True).start()
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass  # the way to end it
    finally:
        runtime.try_shutdown()


def _listen(executor: Executor, manager: ComponentManager) -> None:
    """Hand each request to the loop, which may load it between two callbacks."""
    for line in _lines():
        executor.call_soon_threadsafe(partial(_load, manager, json.loads(line)))


def _lines() -> Iterator[bytes]:
    pieces = program_input.get()
    if pieces is None:
        yield from sys.stdin.buffer
        return
    while True:
        yield pieces.get()


def _load(manager: ComponentManager, request: dict[str, Any]) -> None:
    arguments = arguments_of_words(request["arguments"])
    manager.load(request["package"], request["plugin"], arguments, "launch file")
