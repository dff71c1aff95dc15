"""``navette run``: run unmodified ROS 2 programs on Navette."""

import sys
from pathlib import Path
from typing import Annotated

import click

from navette.cli.completing_installed import complete_programs
from navette.cli.options import Argument, Option

Words = Annotated[
    list[str],
    Argument(
        metavar="PROGRAM [ARGS]...",
        help="FILE.py, PACKAGE EXECUTABLE, or MODULE:Class of a node, with the"
        " arguments of the program, including --ros-args. [bold]--with[/bold]"
        " PROGRAM [ARGS] runs another program in the same process.",
        complete=complete_programs,
    ),
]
OnNavette = Annotated[
    bool,
    Option("--navette", help="Use Navette even if ROS 2 is installed."),
]
SearchPath = Annotated[
    list[Path] | None,
    Option("--path", metavar="FOLDER", help="Search this folder for modules first."),
]
Strict = Annotated[
    bool,
    Option(
        "--strict",
        help="Refuse what ROS 2 refuses: integers for float parameters, long names,"
        " waits that never end there.",
    ),
]


def run(
    words: Words,
    on_navette: OnNavette = False,
    path: SearchPath = None,
    strict: Strict = False,
) -> None:
    """Run unmodified ROS 2 programs without ROS 2.

    The imports rclpy, std_msgs.msg, tf2_ros, … resolve to Navette's modules. If ROS 2
    is installed, the program runs on ROS 2 unless --navette is given.
    """
    from navette.ros2.names import install, installed_rclpy
    from navette.ros2.names.process import run_alone, run_together
    from navette.ros2.names.targets import read_programs, uncalled_main
    from navette.ros2.workspace import activate
    from navette.runtime import strict_mode

    sys.path[:0] = map(str, path or ())
    if strict:
        strict_mode.enable()
    real = installed_rclpy()
    if real is None or on_navette:
        install(instead_of_ros=on_navette)
    else:
        click.echo(
            f"navette: running on ROS 2, whose rclpy is installed at {real};"
            " navette run --navette … runs on Navette instead",
            err=True,
        )
    activate()
    programs = read_programs(words)
    advice = uncalled_main(words)
    if advice is not None:
        click.echo(f"navette: {advice}", err=True)
    code = run_alone(programs[0]) if len(programs) == 1 else run_together(programs)
    raise click.exceptions.Exit(code)
