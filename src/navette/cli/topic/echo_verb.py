"""``navette topic echo``: the command."""

from navette.cli.session import connect
from navette.cli.topic.echo_options import EchoOptions


def echo(options: EchoOptions) -> None:
    """Print what is published on a topic; the last of a latched one at once."""
    from navette.cli.topic.echo import echo as print_messages

    with connect(node_name=options.node_name) as node:
        print_messages(node, options)
