"""``navette topic pub``: the command."""

from navette.cli.session import connect
from navette.cli.topic.pub_options import PublishOptions


def pub(options: PublishOptions) -> None:
    """Publish a message, at a rate until Ctrl-C, or as often as you say."""
    from navette.cli.topic.publishing import publish

    with connect(node_name=options.node_name) as node:
        publish(node, options)
