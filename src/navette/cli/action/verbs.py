"""The verbs of ``navette action``."""

from navette.cli.action import listing
from navette.cli.action.send_goal import send_goal
from navette.cli.commands import Group

action = Group("action", help="List and inspect actions, and send goals.")
action.command("list")(listing.list_)
action.command("type")(listing.type_)
action.command()(listing.find)
action.command()(listing.info)
action.command("send_goal")(send_goal)
