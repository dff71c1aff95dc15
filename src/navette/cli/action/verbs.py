"""The verbs of ``navette action``."""

import typer

from navette.cli.action import goals, looking

action = typer.Typer(
    name="action",
    help="Look into actions: list, type, find, info; and send goals.",
    no_args_is_help=True,
)
action.command("list")(looking.list_)
action.command("type")(looking.type_)
action.command()(looking.find)
action.command()(looking.info)
action.command("send_goal")(goals.send_goal)
