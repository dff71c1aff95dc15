"""Network settings from the environment; loopback only by default."""

import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from navette.errors import InvalidValueError

DEFAULT_ROUTER = "tcp/127.0.0.1:7447"
DEFAULT_LISTEN = "tcp/127.0.0.1:0"
SECURE_ROUTER = "tls/127.0.0.1:7447"
SECURE_LISTEN = "tls/127.0.0.1:0"
_PRIVATE = "unixsock-stream/"
DEFAULT_MAX_MESSAGE_BYTES = 128 * 1024 * 1024
DEFAULT_SERVICE_TIMEOUT_S = 600.0
_SERVICE_TIMEOUTS_S = 0.1, 1e7


@dataclass(frozen=True)
class Settings:
    """How to join the network.

    Args:
        router: endpoints of the router; a process that finds none there becomes the
            router.
        listen: endpoints at which other processes reach this one.
        session_file: a Zenoh configuration (JSON5) to start from.
        router_file: the same for the router, if this process becomes the router.
        overrides: keys of the session's Zenoh configuration and their values (JSON5).
        explicit: which of ``router`` and ``listen`` were set: they override the files.
        max_message_bytes: longer messages are rejected.
        service_timeout_s: time for the reply of another process; an action's result is
            requested again after it.
        retransmit: topics (names or shell patterns) whose reliable samples are resent
            when they were lost.
        security: folder of credentials that every link requires; None: none.
    """

    router: tuple[str, ...] = (DEFAULT_ROUTER,)
    listen: tuple[str, ...] = (DEFAULT_LISTEN,)
    session_file: Path | None = None
    router_file: Path | None = None
    overrides: tuple[tuple[str, str], ...] = ()
    explicit: frozenset[str] = frozenset()
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES
    service_timeout_s: float = DEFAULT_SERVICE_TIMEOUT_S
    retransmit: tuple[str, ...] = ()
    security: Path | None = None

    @property
    def has_rules(self) -> bool:
        """Whether access rules may limit the keys."""
        files = self.security, self.session_file, self.router_file
        return any(file is not None for file in files)

    @property
    def is_local(self) -> bool:
        """Whether all endpoints belong to this machine."""
        return all(map(_is_local, (*self.router, *self.listen)))

    @property
    def is_private(self) -> bool:
        """Whether only programs of this user can connect: endpoints are files."""
        return all(end.startswith(_PRIVATE) for end in (*self.router, *self.listen))

    def within(self, router: str, listen: str) -> "Settings":
        """Return the settings for a private run with these endpoints."""
        return replace(
            self,
            router=(router,),
            listen=(listen,),
            session_file=None,
            router_file=None,
            overrides=(),
            security=None,
            explicit=frozenset({"router", "listen"}),
        )

    @classmethod
    def from_environment(
        cls, environment: Mapping[str, str] = os.environ
    ) -> "Settings":
        """Read ``NAVETTE_ROUTER``, ``NAVETTE_LISTEN`` (separated by commas),
        ``ZENOH_SESSION_CONFIG_URI``, ``ZENOH_ROUTER_CONFIG_URI``,
        ``ZENOH_CONFIG_OVERRIDE``, ``NAVETTE_SECURITY``, ``NAVETTE_MAX_MESSAGE_BYTES``,
        ``NAVETTE_SERVICE_TIMEOUT`` and ``NAVETTE_RETRANSMIT``.

        Raises:
            InvalidValueError: a value is invalid; names variable and allowed values.
        """
        overrides = _overrides(environment, "ZENOH_CONFIG_OVERRIDE")
        router = _endpoints(environment, "NAVETTE_ROUTER")
        router = router or _pop_endpoints(overrides, "connect/endpoints")
        listen = _endpoints(environment, "NAVETTE_LISTEN")
        listen = listen or _pop_endpoints(overrides, "listen/endpoints")
        given = {"router": router, "listen": listen}
        folder = environment.get("NAVETTE_SECURITY", "")
        # With passwords or rules only, links are not encrypted.
        secure = bool(folder) and (Path(folder) / "cert.pem").is_file()
        return cls(
            router=router or (SECURE_ROUTER if secure else DEFAULT_ROUTER,),
            listen=listen or (SECURE_LISTEN if secure else DEFAULT_LISTEN,),
            security=Path(folder) if folder else None,
            session_file=_file(environment, "ZENOH_SESSION_CONFIG_URI"),
            router_file=_file(environment, "ZENOH_ROUTER_CONFIG_URI"),
            overrides=tuple(overrides.items()),
            explicit=frozenset(name for name, value in given.items() if value),
            max_message_bytes=_positive(
                environment, "NAVETTE_MAX_MESSAGE_BYTES", DEFAULT_MAX_MESSAGE_BYTES
            ),
            service_timeout_s=_seconds(
                environment, "NAVETTE_SERVICE_TIMEOUT", DEFAULT_SERVICE_TIMEOUT_S
            ),
            retransmit=_topics(environment, "NAVETTE_RETRANSMIT"),
        )


def _is_local(endpoint: str) -> bool:
    if endpoint.startswith(_PRIVATE):
        return True
    host = endpoint.partition("/")[2].rpartition(":")[0]
    return host.startswith(("127.", "localhost", "[::1]"))


def _list(environment: Mapping[str, str], name: str) -> tuple[str, ...]:
    parts = (part.strip() for part in environment.get(name, "").split(","))
    return tuple(part for part in parts if part)


def _topics(environment: Mapping[str, str], name: str) -> tuple[str, ...]:
    topics = _list(environment, name)
    for topic in topics:
        if not topic.startswith(("/", "*")):
            raise InvalidValueError(
                f"{name}: {topic!r} is not a full topic name; expected /topic or a "
                "pattern such as /arm/*"
            )
    return topics


def _endpoints(environment: Mapping[str, str], name: str) -> tuple[str, ...]:
    endpoints = _list(environment, name)
    for endpoint in endpoints:
        protocol, slash, address = endpoint.partition("/")
        if not (protocol.isalnum() and slash and address):
            raise InvalidValueError(
                f"{name}: {endpoint!r} is not an endpoint; expected protocol/address, "
                f"such as {DEFAULT_ROUTER}"
            )
    return endpoints


def _overrides(environment: Mapping[str, str], name: str) -> dict[str, str]:
    """Return the values (JSON5) by key of ``key=value;key=value``, as in rmw_zenoh."""
    overrides = {}
    for part in environment.get(name, "").split(";"):
        if not part.strip():
            continue
        key, equals, value = part.partition("=")
        if not (key.strip() and equals and value.strip()):
            raise InvalidValueError(
                f"{name}: {part!r} is not key=value; expected for example "
                "transport/link/tx/lease=60000;scouting/multicast/enabled=false"
            )
        overrides[key.strip()] = value.strip()
    return overrides


def _pop_endpoints(overrides: dict[str, str], key: str) -> tuple[str, ...]:
    """Remove and return a list of endpoints; other forms remain for Zenoh to read."""
    try:
        endpoints = json.loads(overrides.get(key, "null"))
    except ValueError:
        return ()
    if not isinstance(endpoints, list):
        return ()
    del overrides[key]
    return tuple(map(str, endpoints))


def _file(environment: Mapping[str, str], name: str) -> Path | None:
    text = environment.get(name, "")
    if not text:
        return None
    path = Path(text)
    if not path.is_file():
        raise InvalidValueError(f"{name}: file {text} does not exist")
    return path


def _positive(environment: Mapping[str, str], name: str, default: int) -> int:
    text = environment.get(name, "")
    if not text:
        return default
    if not (text.isascii() and text.isdigit() and int(text) > 0):
        raise InvalidValueError(f"{name} {text!r}: expected a number of bytes > 0")
    return int(text)


def _seconds(environment: Mapping[str, str], name: str, default: float) -> float:
    text = environment.get(name, "")
    if not text:
        return default
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    least, most = _SERVICE_TIMEOUTS_S
    if not least <= seconds <= most:  # also false for NaN
        raise InvalidValueError(
            f"{name} {text!r}: expected a number of seconds from {least:g} to {most:g}"
        )
    return seconds
