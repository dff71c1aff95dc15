"""``navette run``: unmodified ROS 2 programs on Navette."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from navette.cli.completing_installed import complete_programs

Words = Annotated[
    list[str],
    typer.Argument(
        metavar="PROGRAM [ARGS]...",
        help="FILE.py, PACKAGE EXECUTABLE, or MODULE:Class of a node, and what the"
        " program is to find in sys.argv, --ros-args included. [bold]--with[/bold]"
        " PROGRAM [ARGS] adds another one in the same process.",
        autocompletion=complete_programs,
    ),
]
OnNavette = Annotated[
    bool,
    typer.Option("--navette", help="On Navette even where ROS 2 is installed."),
]
SearchPath = Annotated[
    list[Path] | None,
    typer.Option("--path", metavar="FOLDER", help="Look for modules here first."),
]


def run(words: Words, on_navette: OnNavette = False, path: SearchPath = None) -> None:
    """Run ROS 2 programs as they are, without ROS 2.

    import rclpy, std_msgs.msg, tf2_ros, … mean Navette's modules. Where ROS 2 is
    installed, the program runs on ROS 2, unless --navette is given.
    """
    from navette.ros2.names import install, installed_rclpy
    from navette.ros2.names.process import run_alone, run_together
    from navette.ros2.names.targets import read_programs
    from navette.ros2.workspace import activate

    sys.path[:0] = map(str, path or ())
    real = installed_rclpy()
    if real is None or on_navette:
        install(instead_of_ros=on_navette)
    else:
        typer.echo(
            f"navette: ROS 2's rclpy is installed at {real}, the program runs on it; "
            "navette run --navette … takes Navette's",
            err=True,
        )
    activate()
    programs = read_programs(words)
    code = run_alone(programs[0]) if len(programs) == 1 else run_together(programs)
    raise typer.Exit(code)
