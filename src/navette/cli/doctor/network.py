"""Check the network: transport, router, domain."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from navette.cli.doctor.findings import Diagnosis, Rating, plural
from navette.cli.doctor.processes import Process, listener
from navette.cli.doctor.router_diagnosis import PortProbe, Refusal, probe, refusal
from navette.files.runs import RunInfo, chosen_run, live_runs
from navette.transports import EndpointKind

if TYPE_CHECKING:
    from navette.transports.zenoh.tokens import Token

NETWORK = "Network"

_LOCAL = {"127.0.0.1", "localhost", "[::1]", "::1"}
_PROBED = {"tcp", "tls", "ws"}  # protocols over TCP


@dataclass(frozen=True)
class Router:
    """Endpoint of the router, and what was found there.

    Args:
        endpoint: Zenoh endpoint, such as tcp/127.0.0.1:7447.
        probe: result of a TCP connection; None for other protocols.
        process: the process that listens there, if local and visible.
        refusal: why it rejects the session; None if it does not.
    """

    endpoint: str
    probe: PortProbe | None = None
    process: Process | None = None
    refusal: Refusal | None = None

    @property
    def is_stopped(self) -> bool:
        """Whether its process is stopped."""
        return self.process is not None and self.process.is_stopped

    @property
    def is_here(self) -> bool:
        return _address(self.endpoint)[0] in _LOCAL


@dataclass(frozen=True)
class Network:
    """State of the network before connecting.

    Args:
        transport: value of NAVETTE_TRANSPORT.
        routers: one per endpoint.
        nodes: full names by domain, as listed by the router; None without a router.
        published: topics by domain and full name of the node.
        session_file: value of ZENOH_SESSION_CONFIG_URI.
        overrides: value of ZENOH_CONFIG_OVERRIDE.
        middleware: value of RMW_IMPLEMENTATION, for ROS 2 programs.
        run: the private run that programs started here join; None: the shared network.
        other_runs: names of the user's other runs.
    """

    transport: str = ""
    routers: tuple[Router, ...] = ()
    nodes: Mapping[int, Sequence[str]] | None = field(default_factory=dict)
    published: Mapping[int, Mapping[str, Sequence[str]]] = field(default_factory=dict)
    session_file: str = ""
    overrides: str = ""
    middleware: str = ""
    run: RunInfo | None = None
    other_runs: tuple[str, ...] = ()

    @property
    def is_alone(self) -> bool:
        """Whether programs started here do not use the network."""
        return self.transport == "inprocess"

    @property
    def is_out_of_reach(self) -> bool:
        """Whether the router is on another machine and does not respond."""
        reached = any(
            router.is_here or router.probe in (None, PortProbe.OPEN)
            for router in self.routers
        )
        return bool(self.routers) and not reached and not self.session_file


def look_at_network() -> Network:
    """Probe the router's endpoints and request its list of nodes."""
    from navette.transports.zenoh import Settings
    from navette.transports.zenoh.config import router_endpoints
    from navette.transports.zenoh.discovery import known_to_router

    run = chosen_run()
    settings = Settings.from_environment()
    if run is not None:
        settings = settings.within(run.router, run.new_endpoint())
    known = known_to_router(settings)
    nodes, published = _by_domain(known or ())
    routers = [_router(endpoint) for endpoint in router_endpoints(settings)]
    if known is None:
        routers = [_with_refusal(router, settings.security) for router in routers]
    return Network(
        os.environ.get("NAVETTE_TRANSPORT", ""),
        tuple(routers),
        None if known is None else nodes,
        published,
        os.environ.get("ZENOH_SESSION_CONFIG_URI", ""),
        os.environ.get("ZENOH_CONFIG_OVERRIDE", ""),
        os.environ.get("RMW_IMPLEMENTATION", ""),
        run,
        tuple(each.name for each in live_runs() if each != run),
    )


def _by_domain(
    tokens: "Iterable[Token]",
) -> tuple[dict[int, list[str]], dict[int, dict[str, list[str]]]]:
    """Return node names by domain, and published topics by domain and node."""
    from navette.transports.zenoh.tokens import EndpointToken

    nodes: dict[int, list[str]] = {}
    published: dict[int, dict[str, list[str]]] = {}
    for token in tokens:
        name, domain = token.node.full_name, token.domain_id
        if not isinstance(token, EndpointToken):
            nodes.setdefault(domain, []).append(name)
        elif token.kind is EndpointKind.PUBLISHER:
            topics = published.setdefault(domain, {})
            topics.setdefault(name, []).append(token.topic)
    return {domain: sorted(nodes[domain]) for domain in sorted(nodes)}, published


def _router(endpoint: str) -> Router:
    protocol = endpoint.partition("/")[0]
    host, port = _address(endpoint)
    if protocol not in _PROBED or port is None:
        return Router(endpoint)
    found = probe(host.strip("[]"), port)
    here = found is PortProbe.OPEN and host in _LOCAL
    return Router(endpoint, found, listener(port) if here else None)


def _with_refusal(router: Router, security: Path | None) -> Router:
    """Add the reason of a rejected session."""
    host, port = _address(router.endpoint)
    if router.probe is not PortProbe.OPEN or port is None or router.is_stopped:
        return router
    address = host.strip("[]"), port
    why = refusal(router.endpoint, address, security, router.process)
    return replace(router, refusal=why)


def _address(endpoint: str) -> tuple[str, int | None]:
    """Return host and port of ``tcp/host:port?metadata#config``."""
    address = endpoint.partition("/")[2].partition("?")[0].partition("#")[0]
    host, _, port = address.rpartition(":")
    return host, int(port) if port.isdecimal() else None


def check_network(network: Network, domain: int | None) -> Iterator[Diagnosis]:
    """Check that programs started here reach the others.

    Args:
        domain: domain of this process; None if it could not connect.
    """
    if network.is_alone:
        yield Diagnosis(
            Rating.PROBLEM,
            NETWORK,
            "transport",
            "NAVETTE_TRANSPORT=inprocess: programs started here are isolated",
            "unset NAVETTE_TRANSPORT",
        )
    if network.session_file:
        text = f"settings of {network.session_file} (ZENOH_SESSION_CONFIG_URI)"
        yield Diagnosis(Rating.NOTE, NETWORK, "Zenoh", text)
    if network.overrides:
        text = f"{network.overrides} (ZENOH_CONFIG_OVERRIDE)"
        yield Diagnosis(Rating.NOTE, NETWORK, "Zenoh", text)
    yield from _run_findings(network)
    for router in network.routers if network.run is None else ():
        yield _router_finding(router, speaks=network.nodes is not None)
    if domain is not None:
        yield from _domain_findings(network.nodes or {}, domain)
    if network.middleware and network.middleware != "rmw_zenoh_cpp":
        yield Diagnosis(
            Rating.WARNING,
            NETWORK,
            "ROS 2",
            f"its programs started here use {network.middleware} and cannot"
            " communicate with Navette's",
            "export RMW_IMPLEMENTATION=rmw_zenoh_cpp",
        )


def _run_findings(network: Network) -> Iterator[Diagnosis]:
    """Report the private run that programs started here join."""
    run, others = network.run, network.other_runs
    if run is not None:
        responds = network.nodes is not None
        text = f"{run.name}: {run.command}, world {run.world}, process {run.pid}"
        data = {"run": run.name, "pid": run.pid, "others": list(others)}
        yield Diagnosis(
            Rating.GOOD if responds else Rating.PROBLEM,
            NETWORK,
            "run",
            f"{text}; private to this user" if responds else f"{text} does not respond",
            "" if responds else f"if it is stopped (Ctrl-Z): kill -CONT {run.pid}",
            data,
        )
    elif others:
        text = f"programs started here do not join run {', '.join(others)}"
        advice = f"to join: --run {others[0]}, or export NAVETTE_RUN={others[0]}"
        yield Diagnosis(Rating.NOTE, NETWORK, "runs", text, advice)


def _router_finding(router: Router, *, speaks: bool) -> Diagnosis:
    process = router.process
    data = {
        "endpoint": router.endpoint,
        "answers": None if router.probe is None else router.probe is PortProbe.OPEN,
        "pid": process.pid if process else None,
    }
    by = f", served by {process.command} (process {process.pid})" if process else ""
    if router.probe is None:
        text = f"{router.endpoint}, whose protocol cannot be probed"
        return Diagnosis(Rating.NOTE, NETWORK, "router", text, data=data)
    if process is not None and process.is_stopped:
        return Diagnosis(
            Rating.PROBLEM,
            NETWORK,
            "router",
            f"{router.endpoint} belongs to {process.command} (process {process.pid}),"
            " which is stopped: no program can connect",
            f"continue it: fg in its terminal, or kill -CONT {process.pid}; or end it:"
            f" kill -KILL {process.pid}",
            data,
        )
    if router.probe is PortProbe.OPEN and speaks:
        return Diagnosis(
            Rating.GOOD, NETWORK, "router", f"{router.endpoint}{by}", data=data
        )
    if router.probe is PortProbe.OPEN:
        why = router.refusal or Refusal("rejects the session", "")
        text = f"{router.endpoint} is open{by}, but {why.text}"
        return Diagnosis(Rating.PROBLEM, NETWORK, "router", text, why.advice, data)
    if router.is_here:
        text = f"{router.endpoint} is free: the first program becomes the router"
        return Diagnosis(Rating.NOTE, NETWORK, "router", text, data=data)
    how, advice = _UNREACHED[router.probe]
    text = f"{router.endpoint} {how}"
    return Diagnosis(Rating.PROBLEM, NETWORK, "router", text, advice, data)


_THERE = "start Navette on that machine with NAVETTE_ROUTER set to this address"
_UNREACHED = {
    PortProbe.REFUSED: (
        "refuses connections: the machine is on, but no router runs there",
        _THERE,
    ),
    PortProbe.TIMED_OUT: (
        "does not respond",
        f"check that the machine is on and that no firewall blocks it; then {_THERE}",
    ),
    PortProbe.UNREACHABLE: (
        "cannot be reached: no route to that address",
        "check with ping that this machine is on the same network",
    ),
    PortProbe.UNKNOWN_HOST: (
        "cannot be reached: the host name is unknown",
        "check the spelling of the name, or use the IP address",
    ),
}


def _domain_findings(
    nodes: Mapping[int, Sequence[str]], domain: int
) -> Iterator[Diagnosis]:
    """Report nodes in other domains."""
    elsewhere = {d: names for d, names in nodes.items() if d != domain}
    others = ", ".join(
        f"{plural(len(names), 'node')} in {d}" for d, names in elsewhere.items()
    )
    here = nodes.get(domain)
    text = f"{domain} (ROS_DOMAIN_ID)"
    data = {"domain": domain, "nodes": {d: list(names) for d, names in nodes.items()}}
    if not elsewhere:
        yield Diagnosis(Rating.GOOD, NETWORK, "domain", text, data=data)
    elif here:
        yield Diagnosis(Rating.NOTE, NETWORK, "domain", f"{text}; {others}", data=data)
    else:
        yield Diagnosis(
            Rating.WARNING,
            NETWORK,
            "domain",
            f"{text} is empty; {others}",
            f"to see them: export ROS_DOMAIN_ID={next(iter(elsewhere))}",
            data,
        )
