"""Number of Zenoh's threads."""

import os

from navette.transports.zenoh.settings import Settings

_VARIABLE = "ZENOH_RUNTIME"
# Between machines all links may be lost at once; on one machine only links to stopped
# processes.
_BETWEEN_MACHINES = {"rx": 64, "net": 64, "acc": 16, "tx": 8}
_LOCAL = {"rx": 8, "net": 4, "acc": 4}


def provide_threads(settings: Settings) -> None:
    """Set Zenoh's thread numbers; called before Zenoh is used.

    Zenoh (1.10) closes the socket of a lost link in the thread that has it last, which
    takes up to ten seconds, because unsent data is tried all the while (``SO_LINGER``,
    fixed in Zenoh). By default it has two threads to receive, and one each to open
    links, to accept and to send: after two lost links nothing is received any more
    (decision 0012). An idle thread costs 13 kB. A value in the environment is kept.
    """
    value = os.environ.get(_VARIABLE)
    # Else it was set by the user, not by this function in the parent process.
    if value in (None, _text(_LOCAL), _text(_BETWEEN_MACHINES)):
        counts = _LOCAL if settings.is_local else _BETWEEN_MACHINES
        os.environ[_VARIABLE] = _text(counts)


def _text(counts: dict[str, int]) -> str:
    parts = (f"{name}:(worker_threads:{count})" for name, count in counts.items())
    return f"({','.join(parts)})"
