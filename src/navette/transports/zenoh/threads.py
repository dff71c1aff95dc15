"""How many threads Zenoh takes what arrives with."""

import os

from navette.transports.zenoh.settings import Settings

_VARIABLE = "ZENOH_RUNTIME"
# Between machines all links may be lost at once; on one, those to stopped processes.
_FAR, _NEAR = 64, 8


def provide_threads(settings: Settings) -> None:
    """Enough for the links that may be lost; to be called before Zenoh is used.

    Zenoh (1.10) closes the socket of a lost link in a thread that takes what arrives,
    and that may last ten seconds: what has not been sent is tried all the while
    (``SO_LINGER``, fixed in Zenoh). It has two such threads by itself: with two lost
    links nothing arrives any more, from nobody (decision 0012). One that waits for work
    costs 13 kB. What the environment says wins.
    """
    count = _NEAR if settings.is_local else _FAR
    os.environ.setdefault(_VARIABLE, f"(rx:(worker_threads:{count}))")
