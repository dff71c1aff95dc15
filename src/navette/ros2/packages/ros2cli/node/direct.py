"""A node of its own for a tool, with the arguments that tools share."""

import os
from argparse import ArgumentParser
from types import TracebackType
from typing import Any, Self

from navette.ros2.packages.ros2cli.node import NODE_NAME_PREFIX
from navette.runtime import Context, Future, Node, SingleThreadedExecutor

DEFAULT_TIMEOUT = 0.5


class DirectNode:
    """A node that has looked at the graph for ``args.spin_time`` seconds (0.5).

    Used in a ``with`` statement; attributes are those of the node.

    Args:
        args: parsed arguments; ``spin_time`` and ``use_sim_time`` are read.
        node_name: default: a hidden name with the number of the process.
    """

    def __init__(self, args: Any, *, node_name: str | None = None) -> None:
        seconds = getattr(args, "spin_time", None)
        self._seconds = DEFAULT_TIMEOUT if seconds is None else float(seconds)
        self._name = node_name or f"{NODE_NAME_PREFIX}_{os.getpid()}"
        self._use_sim_time = bool(getattr(args, "use_sim_time", False))
        self._context: Context | None = None
        self._node: Node | None = None

    @property
    def node(self) -> Node:
        if self._node is None:
            raise RuntimeError(
                "the node exists within `with DirectNode(args) as node:`"
            )
        return self._node

    def __enter__(self) -> Self:
        words = ["--ros-args", "-p", f"use_sim_time:={str(self._use_sim_time).lower()}"]
        self._context = Context()
        self._context.init(args=["tool", *words])
        self._node = Node(
            self._name,
            context=self._context,
            start_parameter_services=False,
            enable_rosout=False,
        )
        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)
        # A future that nothing completes: spin for that long.
        executor.spin_until_future_complete(Future(), timeout_sec=self._seconds)
        executor.remove_node(self._node)
        return self

    def __getattr__(self, name: str) -> Any:
        return getattr(self.node, name)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.node.destroy_node()
        assert self._context is not None, "entered"
        self._context.try_shutdown()
        self._node = None


def add_arguments(parser: ArgumentParser) -> None:
    """Add ``--spin-time`` and ``--use-sim-time``."""
    parser.add_argument(
        "--spin-time",
        type=float,
        default=None,
        help="seconds to wait for the graph",
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true")
