"""Who is on the network at all, whatever the domain; for reports to people."""

import contextlib

import zenoh

from navette.errors import DecodeError
from navette.transports.zenoh.config import client_config
from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.tokens import SPACE, parse_token

_ASK_S = 1.0


def nodes_by_domain(settings: Settings) -> dict[int, list[str]] | None:
    """Domain → full names of the nodes that the router knows; None: no router.

    Those are also such as cannot be reached from here.
    """
    try:
        session = zenoh.open(client_config(settings))
    except zenoh.ZError:
        return None
    found: dict[int, list[str]] = {}
    with session:
        replies = session.liveliness().get(f"{SPACE}/*/*/*/*/NN/**", timeout=_ASK_S)
        keys = [str(reply.ok.key_expr) for reply in replies if reply.ok]
    for key in keys:
        # Hostile or foreign ones are complained of by the graph.
        with contextlib.suppress(DecodeError):
            token = parse_token(key)
            found.setdefault(token.domain_id, []).append(token.node.full_name)
    return {domain: sorted(found[domain]) for domain in sorted(found)}
