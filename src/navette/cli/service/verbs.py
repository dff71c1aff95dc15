"""The verbs of ``navette service``."""

import typer

from navette.cli.service import calling, echoing, looking

service = typer.Typer(
    name="service",
    help="Look into services: list, type, find, info, echo; and call them.",
    no_args_is_help=True,
)
service.command("list")(looking.list_)
service.command("type")(looking.type_)
service.command()(looking.find)
service.command()(looking.info)
service.command(context_settings={"ignore_unknown_options": True})(calling.call)
service.command()(echoing.echo)
