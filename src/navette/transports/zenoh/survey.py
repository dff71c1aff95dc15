"""Who is on the network at all, whatever the domain; for reports to people."""

from collections import Counter

import zenoh

from navette.transports.zenoh.config import client_config
from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.tokens import SPACE

_ASK_S = 1.0


def nodes_by_domain(settings: Settings) -> dict[int, int] | None:
    """Domain → number of nodes that the router knows; None if no router answers."""
    try:
        session = zenoh.open(client_config(settings))
    except zenoh.ZError:
        return None
    with session:
        replies = session.liveliness().get(f"{SPACE}/*/*/*/*/NN/**", timeout=_ASK_S)
        domains = [
            str(reply.ok.key_expr).split("/")[1] for reply in replies if reply.ok
        ]
    return dict(Counter(int(domain) for domain in domains if domain.isdecimal()))
