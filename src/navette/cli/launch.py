"""``navette launch``: run ROS 2 launch files on Navette."""

import sys
from multiprocessing import forkserver
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
    forks = processes and not show_args and sys.platform == "linux"
    if forks:  # imports Navette while this process does
        forkserver.set_forkserver_preload(["navette.cli.launch_preload"])
        forkserver.ensure_running()
    from navette.files.runs import pin_run
    from navette.ros2.launch import launch as run_launch
    from navette.ros2.launch import parse_launch_arguments, show_arguments
    from navette.ros2.launch.session import find_launch_file
    from navette.ros2.names import install
    from navette.supervisor import ForkServer, ProcessManager

    install(instead_of_ros=on_navette)
    path, rest = find_launch_file(words)
    if show_args:
        show(show_arguments(path))
        return
    pin_run()
    manager = ProcessManager(ForkServer() if forks else None) if processes else None
    code = run_launch(path, parse_launch_arguments(rest), manager=manager, debug=debug)
    raise click.exceptions.Exit(code)
