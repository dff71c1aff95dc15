"""The verbs of ``navette topic``."""

import typer

from navette.cli.bundles import unbundled
from navette.cli.topic import echo_verb, look_verbs, measure_verbs, pub_verb

topic = typer.Typer(
    name="topic",
    help="Look into topics: list, info, echo, hz, bw, delay; and publish.",
    no_args_is_help=True,
)
topic.command("list")(look_verbs.list_)
topic.command()(look_verbs.info)
topic.command()(unbundled(echo_verb.echo))
topic.command()(unbundled(measure_verbs.hz))
topic.command()(unbundled(measure_verbs.bw))
topic.command()(unbundled(measure_verbs.delay))
topic.command()(unbundled(pub_verb.pub))
topic.command("type")(look_verbs.type_)
topic.command()(look_verbs.find)
