"""Zenoh ids of Navette's sessions.

A session id has 16 bytes, which the program may choose. Those of Navette begin with a
mark, so that other Navette sessions recognise them.
"""

import secrets

_MARK = "6e617665"  # "nave"
_HEX_DIGITS = 32
# Of two peers the one with the greater id opens the link (rmw_zenoh's autoconnect
# strategy), and the last byte is the most significant one. ROS 2's nodes listen on
# their own machine only, so a node on another machine must open the link to Navette:
# Navette's id has to be the smaller one.
_LOWEST_BYTE = "00"


def new_session_id() -> str:
    """Return a random id for a session of Navette."""
    random_digits = _HEX_DIGITS - len(_MARK) - len(_LOWEST_BYTE)
    return f"{_MARK}{secrets.token_hex(random_digits // 2)}{_LOWEST_BYTE}"


def is_navette_session(session_id: str) -> bool:
    return len(session_id) == _HEX_DIGITS and session_id.startswith(_MARK)
