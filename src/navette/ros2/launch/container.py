"""Container of composable nodes: loads node classes, runs them on one executor.

The program serves ROS 2's composition services and reads the requests of its launch
file from its standard input, one line of JSON each:
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
    """Load the requested components until the shutdown."""
    runtime.init()
    context = get_default_context()
    executor = Executor(context=context)
    node = Node("component_container")
    executor.add_node(node)
    manager = ComponentManager(node, executor)
    threading.Thread(
        target=_read_requests, args=(executor, manager), daemon=True
    ).start()
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass  # ends the container
    finally:
        runtime.try_shutdown()


def _read_requests(executor: Executor, manager: ComponentManager) -> None:
    """Queue each request on the executor's loop."""
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
