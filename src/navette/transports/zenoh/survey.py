"""Who is on the network at all, whatever the domain; for reports to people."""

import contextlib
from itertools import islice

import zenoh

from navette.errors import DecodeError
from navette.transports.zenoh.config import client_config
from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.tokens import SPACE, Token, parse_token

_ASK_S = 1.0
_MOST = 100_000


def known_to_router(settings: Settings) -> list[Token] | None:
    """All nodes and endpoints that the router knows; None: no router.

    Those are also such as cannot be reached from here.
    """
    try:
        session = zenoh.open(client_config(settings))
    except zenoh.ZError:
        return None
    found: list[Token] = []
    with session:
        replies = session.liveliness().get(f"{SPACE}/**", timeout=_ASK_S)
        keys = [str(r.ok.key_expr) for r in islice(replies, _MOST) if r.ok]
    for key in keys:
        # Hostile or foreign ones are complained of by the graph.
        with contextlib.suppress(DecodeError):
            found.append(parse_token(key))
    return found
