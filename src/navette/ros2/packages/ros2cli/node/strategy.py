"""The node of a tool; Navette has no daemon, so it is always a node of its own."""

from argparse import ArgumentParser

from navette.ros2.packages.ros2cli.node import direct

__all__ = ["NodeStrategy", "add_arguments"]


class NodeStrategy(direct.DirectNode):
    """A node within a ``with`` statement."""


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of direct nodes, and ``--no-daemon``, which changes nothing."""
    direct.add_arguments(parser)
    parser.add_argument("--no-daemon", action="store_true")
