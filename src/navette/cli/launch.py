"""``navette launch``: run ROS 2 launch files on Navette."""

from typing import Annotated

import click

from navette.cli.completing_installed import complete_launch_files
from navette.cli.options import Argument, Option
from navette.cli.output import show

Words = Annotated[
    list[str],
    Argument(
        metavar="FILE|PACKAGE FILE [NAME:=VALUE]...",
        help="A launch file in Python, XML or YAML, and its arguments.",
        complete=complete_launch_files,
    ),
]
ShowArgs = Annotated[
    bool,
    Option("--show-args", "-s", help="List the file's arguments and exit."),
]
Processes = Annotated[
    bool,
    Option("--processes", help="Run each node in its own process."),
]
Debug = Annotated[bool, Option("--debug", "-d", help="Print debug messages.")]
OnNavette = Annotated[
    bool,
    Option("--navette", help="Use Navette even if ROS 2 is installed."),
]


def launch(
    words: Words,
    show_args: ShowArgs = False,
    processes: Processes = False,
    debug: Debug = False,
    on_navette: OnNavette = False,
) -> None:
    """Run a launch file: all its nodes in this process, or each in its own process.

    Ctrl-C ends everything that the launch started. Exit code 1: the launch or one of
    its processes failed.
    """
    from navette.ros2.launch import launch as run_launch
    from navette.ros2.launch import parse_launch_arguments, show_arguments
    from navette.ros2.launch.session import find_launch_file
    from navette.ros2.names import install

    install(instead_of_ros=on_navette)
    path, rest = find_launch_file(words)
    if show_args:
        show(show_arguments(path))
        return
    arguments = parse_launch_arguments(rest)
    raise click.exceptions.Exit(
        run_launch(path, arguments, processes=processes, debug=debug)
    )
