"""The verbs of ``navette service``."""

from navette.cli.commands import Group
from navette.cli.service import calling, echoing, looking

service = Group(
    name="service",
    help="List, inspect and print services, and call them.",
)
service.command("list")(looking.list_)
service.command("type")(looking.type_)
service.command()(looking.find)
service.command()(looking.info)
service.command(context_settings={"ignore_unknown_options": True})(calling.call)
service.command()(echoing.echo)
