"""The verbs of ``navette service``."""

from navette.cli.commands import Group
from navette.cli.service import listing
from navette.cli.service.call import call
from navette.cli.service.echo import echo

service = Group("service", help="List, inspect and print services, and call them.")
service.command("list")(listing.list_)
service.command("type")(listing.type_)
service.command()(listing.find)
service.command()(listing.info)
service.command(context_settings={"ignore_unknown_options": True})(call)
service.command()(echo)
