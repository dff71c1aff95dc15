"""The verbs of ``navette action``."""

from navette.cli.action import goals, looking
from navette.cli.commands import Group

action = Group(
    name="action",
    help="List and inspect actions, and send goals.",
)
action.command("list")(looking.list_)
action.command("type")(looking.type_)
action.command()(looking.find)
action.command()(looking.info)
action.command("send_goal")(goals.send_goal)
