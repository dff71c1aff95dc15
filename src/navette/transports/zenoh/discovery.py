"""All nodes and endpoints on the network, in every domain; for ``navette doctor``."""

import contextlib
from itertools import islice

import zenoh

from navette.errors import DecodeError
from navette.transports.zenoh.config import client_config
from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.tokens import SPACE, Token, parse_token

_QUERY_S = 1.0
_MAX_TOKENS = 100_000


def known_to_router(settings: Settings) -> list[Token] | None:
    """Return all nodes and endpoints in the router's graph; None without a router.

    Some of them may not be reachable from here.
    """
    try:
        session = zenoh.open(client_config(settings))
    except zenoh.ZError:
        return None
    found: list[Token] = []
    with session:
        replies = session.liveliness().get(f"{SPACE}/**", timeout=_QUERY_S)
        keys = [str(r.ok.key_expr) for r in islice(replies, _MAX_TOKENS) if r.ok]
    for key in keys:
        # The graph logs tokens that it cannot parse.
        with contextlib.suppress(DecodeError):
            found.append(parse_token(key))
    return found
