"""Zenoh configurations: of a peer, of the router, of a client that only asks."""

import json
from pathlib import Path
from typing import Any

import zenoh

from navette.errors import InvalidValueError
from navette.transports.zenoh.security import Security
from navette.transports.zenoh.settings import Settings

ASK_TIMEOUT_MS = 1000
"""A router that is stopped (SIGSTOP) still has its port: it is not waited for."""

# So long a link may take to open. A peer is called once, when it is heard of: many
# processes that start at once need longer than anybody would think.
_OPEN_TIMEOUT_MS = 10_000

# What a message has around it; one that is too long by less is complained of.
_ROOM_BYTES = 1024 * 1024

# A link that is silent for its lease (10 s) is lost. What waits in it is then still
# tried to be sent, each batch for the time between two signs of life; until that is
# over the link is half there: a new one joins the remains of it, is misunderstood at
# the other end, and ends with them. On one machine nobody cuts a cable, and there may
# be thousands of links: there Zenoh's own number (4) is enough.
_KEEP_ALIVES_BETWEEN_MACHINES = 20

# As in rmw_zenoh's default configurations, but for the retries: the router is in one
# of the processes, and another one takes over at once.
_COMMON: dict[str, Any] = {
    "connect": {
        "timeout_ms": {"router": -1, "peer": -1, "client": 0},
        "exit_on_failure": {"router": False, "peer": False, "client": True},
        "retry": {
            "period_init_ms": 50,
            "period_max_ms": 1000,
            "period_increase_factor": 2,
        },
    },
    "scouting": {
        # The session waits for those who are there itself (see session.py).
        "delay": 0,
        "multicast": {"enabled": False},
        "gossip": {
            "enabled": True,
            "target": {"router": ["router", "peer"], "peer": ["router"]},
            "autoconnect": {"router": [], "peer": ["router", "peer"]},
            "autoconnect_strategy": {
                "peer": {"to_router": "always", "to_peer": "greater-zid"}
            },
        },
    },
    "timestamping": {"enabled": True},
    "queries_default_timeout": 600_000,
    "transport": {
        "unicast": {
            "open_timeout": _OPEN_TIMEOUT_MS,
            "accept_pending": 1000,
            "max_sessions": 10_000,
        }
    },
}


def peer_config(settings: Settings, zid: str = "") -> zenoh.Config:
    """Of the session that does the work, with that id unless a file says another."""
    config = _base(settings, settings.session_file)
    if zid and config.get_json("id") == "null":
        config.insert_json5("id", json.dumps(zid))
    config.insert_json5("mode", '"peer"')
    if settings.session_file is None or "router" in settings.explicit:
        config.insert_json5("connect/endpoints", json.dumps(settings.router))
    if settings.session_file is None or "listen" in settings.explicit:
        config.insert_json5("listen/endpoints", json.dumps(settings.listen))
    # Zenoh drops those without a word, but does not even put them together.
    longest = _ROOM_BYTES + 2 * settings.max_message_bytes
    config.insert_json5("transport/link/rx/max_message_size", str(longest))
    return config


def client_config(settings: Settings) -> zenoh.Config:
    """Of a session that asks the router who is there."""
    config = peer_config(settings)
    config.insert_json5("mode", '"client"')
    config.insert_json5("listen/endpoints", "[]")
    config.insert_json5("connect/timeout_ms", "0")
    config.insert_json5("transport/unicast/open_timeout", str(ASK_TIMEOUT_MS))
    config.insert_json5("connect/exit_on_failure", "true")
    return config


def router_config(settings: Settings, endpoint: str) -> zenoh.Config:
    """Of a router that listens at one of the places where the others look for it."""
    config = _base(settings, settings.router_file or settings.session_file)
    config.insert_json5("mode", '"router"')
    if settings.router_file is None:
        config.insert_json5("listen/endpoints", json.dumps([endpoint]))
        config.insert_json5("connect/endpoints", "[]")
    return config


def router_endpoints(settings: Settings) -> list[str]:
    """Where the router is looked for."""
    if settings.session_file is None or "router" in settings.explicit:
        return list(settings.router)
    found = json.loads(peer_config(settings).get_json("connect/endpoints"))
    return list(found.get("peer", [])) if isinstance(found, dict) else list(found)


def _base(settings: Settings, path: Path | None) -> zenoh.Config:
    config = _read(path)
    if path is None and not settings.is_local:
        number = str(_KEEP_ALIVES_BETWEEN_MACHINES)
        config.insert_json5("transport/link/tx/keep_alive", number)
    if settings.security is not None:
        security = Security(settings.security)
        if security.is_encrypted:
            _refuse_plain((*settings.router, *settings.listen))
        security.apply(config)
    return config


def _read(path: Path | None) -> zenoh.Config:
    if path is None:
        return zenoh.Config.from_json5(json.dumps(_COMMON))
    try:
        config = zenoh.Config.from_file(str(path))
    except zenoh.ZError as error:
        raise InvalidValueError(f"Zenoh configuration {path}: {error}") from error
    # Latched topics need it, whatever the file says.
    config.insert_json5("timestamping/enabled", "true")
    return config


def _refuse_plain(endpoints: tuple[str, ...]) -> None:
    for endpoint in endpoints:
        if not endpoint.startswith("tls/"):
            raise InvalidValueError(
                f"endpoint {endpoint}: NAVETTE_SECURITY has certificates, so every "
                "endpoint (NAVETTE_ROUTER, NAVETTE_LISTEN) must begin with tls/"
            )
