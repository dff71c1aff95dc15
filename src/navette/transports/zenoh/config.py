"""Zenoh configurations of peers, of the router, and of clients that only query."""

import json
from pathlib import Path
from typing import Any

import zenoh

from navette.errors import InvalidValueError
from navette.transports.zenoh.security import Security
from navette.transports.zenoh.settings import Settings

QUERY_TIMEOUT_MS = 1000
"""Time for a router to respond; a stopped one (SIGSTOP) still has its port."""

# Time for a link to open. A peer is called only once, when it is discovered, and many
# processes that start together take long.
_OPEN_TIMEOUT_MS = 10_000

# Overhead of a message. A message that is too long by less than this is reported.
_OVERHEAD_BYTES = 1024 * 1024

# A link that is silent for its lease (10 s) is closed. Zenoh then still tries to send
# each queued batch, for the time between two keep-alives. A new link that opens
# meanwhile joins the rest of the old one, is misunderstood at the other end, and closes
# with it. On one machine no cable is cut, and there may be thousands of links: there
# Zenoh's own number (4) is enough.
_KEEP_ALIVES_BETWEEN_MACHINES = 20

_CONGESTION = "transport/link/tx/queue/congestion_control"
# Time in µs after which Zenoh closes a link that takes nothing. It is lost for good:
# peers call each other once. With Zenoh's own 5 s, a process that was stopped for 6 s
# while long messages waited received nothing more. As long as the lease, with which the
# link to a stopped process ends anyway: on a busy machine a full link sometimes stays
# blocked until this time, although the other process reads again.
_WAIT_BEFORE_CLOSE = 10_000_000
# Time in µs that a publisher waits for a full queue before it drops a sample, or the
# fragments of a long one. On one machine the other process drains the queue within
# milliseconds, so that a burst is not lost; if that process is stopped, a publisher
# waits once. Between machines Zenoh's own 1 ms and 50 ms apply, because a slow link
# would delay every sample (decision 0012).
_LOCAL_WAIT = {"wait_before_drop": 50_000, "max_wait_before_drop_fragments": 200_000}

# As in rmw_zenoh's default configurations, except for the retries: the router is in
# one of the processes, and another process takes over at once.
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
        # The session itself waits until the present nodes are known (session.py).
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
        },
        # Samples are put into shared memory by the publisher (shared_memory.py).
        "shared_memory": {"transport_optimization": {"messages": ["query", "reply"]}},
    },
}


def peer_config(settings: Settings, zid: str = "") -> zenoh.Config:
    """Return the configuration of a peer.

    Args:
        zid: id of the session, unless a configuration file sets one.
    """
    config = _base(settings, settings.session_file)
    if zid and config.get_json("id") == "null":
        config.insert_json5("id", json.dumps(zid))
    config.insert_json5("mode", '"peer"')
    if settings.session_file is None or "router" in settings.explicit:
        config.insert_json5("connect/endpoints", json.dumps(settings.router))
    if settings.session_file is None or "listen" in settings.explicit:
        config.insert_json5("listen/endpoints", json.dumps(settings.listen))
    # Zenoh drops longer messages silently, without assembling them.
    max_size = _OVERHEAD_BYTES + 2 * settings.max_message_bytes
    config.insert_json5("transport/link/rx/max_message_size", str(max_size))
    for key, value in settings.overrides:
        _override(config, key, value)
    return _secured(config, settings)


def client_config(settings: Settings) -> zenoh.Config:
    """Return the configuration of a session that queries the router."""
    config = peer_config(settings)
    config.insert_json5("mode", '"client"')
    config.insert_json5("listen/endpoints", "[]")
    config.insert_json5("connect/timeout_ms", "0")
    config.insert_json5("transport/unicast/open_timeout", str(QUERY_TIMEOUT_MS))
    config.insert_json5("connect/exit_on_failure", "true")
    return config


def router_config(settings: Settings, endpoint: str) -> zenoh.Config:
    """Return the configuration of a router that listens at ``endpoint``."""
    config = _base(settings, settings.router_file or settings.session_file)
    config.insert_json5("mode", '"router"')
    if settings.router_file is None:
        config.insert_json5("listen/endpoints", json.dumps([endpoint]))
        config.insert_json5("connect/endpoints", "[]")
    return _secured(config, settings)


def router_endpoints(settings: Settings) -> list[str]:
    """Return the endpoints at which the router is expected."""
    if settings.session_file is None or "router" in settings.explicit:
        return list(settings.router)
    found = json.loads(peer_config(settings).get_json("connect/endpoints"))
    return list(found.get("peer", [])) if isinstance(found, dict) else list(found)


def _override(config: zenoh.Config, key: str, value: str) -> None:
    try:
        config.insert_json5(key, value)
    except zenoh.ZError as error:
        raise InvalidValueError(
            f"ZENOH_CONFIG_OVERRIDE: {key}={value} is refused by Zenoh: {error}; "
            "expected a key of its configuration with a JSON5 value"
        ) from error


def _base(settings: Settings, path: Path | None) -> zenoh.Config:
    config = _read(path)
    if path is None:
        wait = str(_WAIT_BEFORE_CLOSE)
        config.insert_json5(f"{_CONGESTION}/block/wait_before_close", wait)
    if path is None and settings.is_local:
        config.insert_json5(f"{_CONGESTION}/drop", json.dumps(_LOCAL_WAIT))
    elif path is None:
        number = str(_KEEP_ALIVES_BETWEEN_MACHINES)
        config.insert_json5("transport/link/tx/keep_alive", number)
    return config


def _secured(config: zenoh.Config, settings: Settings) -> zenoh.Config:
    """Add the requirements of ``NAVETTE_SECURITY``, which nothing overrides."""
    if settings.security is not None:
        security = Security(settings.security)
        if security.is_encrypted:
            _check_encrypted((*settings.router, *settings.listen))
        security.apply(config)
    return config


def _read(path: Path | None) -> zenoh.Config:
    if path is None:
        return zenoh.Config.from_json5(json.dumps(_COMMON))
    try:
        config = zenoh.Config.from_file(str(path))
    except zenoh.ZError as error:
        raise InvalidValueError(f"Zenoh configuration {path}: {error}") from error
    # Transient-local topics require it.
    config.insert_json5("timestamping/enabled", "true")
    return config


def _check_encrypted(endpoints: tuple[str, ...]) -> None:
    for endpoint in endpoints:
        if not endpoint.startswith("tls/"):
            raise InvalidValueError(
                f"endpoint {endpoint}: NAVETTE_SECURITY has certificates, so every "
                "endpoint (NAVETTE_ROUTER, NAVETTE_LISTEN) must begin with tls/"
            )
