"""The verbs of ``navette topic``."""

import typer

from navette.cli.topic import listening, looking

topic = typer.Typer(
    name="topic",
    help="Look into topics: list, info, echo, hz, bw, delay; and publish.",
    no_args_is_help=True,
)
topic.command("list")(looking.list_)
topic.command()(looking.info)
topic.command()(listening.echo)
topic.command("type")(looking.type_)
topic.command()(looking.find)
