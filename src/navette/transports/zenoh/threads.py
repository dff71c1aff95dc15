"""How many threads Zenoh works with."""

import os

from navette.transports.zenoh.settings import Settings

_VARIABLE = "ZENOH_RUNTIME"
# Between machines all links may be lost at once; on one, those to stopped processes.
_FAR = {"rx": 64, "net": 64, "acc": 16, "tx": 8}
_NEAR = {"rx": 8, "net": 4, "acc": 4}


def provide_threads(settings: Settings) -> None:
    """Enough for the links that may be lost; to be called before Zenoh is used.

    Zenoh (1.10) closes the socket of a lost link in whichever thread has it last, and
    that may last ten seconds: what has not been sent is tried all the while
    (``SO_LINGER``, fixed in Zenoh). By itself it has two threads for what arrives and
    one each to open links, to accept and to send: after two lost links nothing arrives
    any more, from nobody (decision 0012). One that waits for work costs 13 kB. What the
    environment says wins.
    """
    said = os.environ.get(_VARIABLE)
    if said in (None, _text(_NEAR), _text(_FAR)):  # the parent's, by this very function
        os.environ[_VARIABLE] = _text(_NEAR if settings.is_local else _FAR)


def _text(counts: dict[str, int]) -> str:
    parts = (f"{name}:(worker_threads:{count})" for name, count in counts.items())
    return f"({','.join(parts)})"
