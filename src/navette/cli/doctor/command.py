"""Run all checks and print the report."""

import logging
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.doctor.findings import Diagnosis, Rating, count
from navette.cli.options import Json, Option
from navette.cli.output import show, show_json
from navette.cli.session import FAILED, connect

if TYPE_CHECKING:
    from navette.cli.doctor.snapshot import Snapshot


def doctor(
    quiet: Annotated[
        bool, Option("--quiet", "-q", help="Print only warnings and problems.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Find problems of this system and suggest what to do.

    Marks: ✓ good, · note, ! warning, ✗ problem. Exit code 1 if there is a problem.
    """
    from navette.cli.doctor import report

    # Report first: disconnecting takes long if a peer is frozen.
    with ExitStack() as joined:
        findings = list(_findings(joined))
        if as_json:
            show_json(report.as_json(findings))
        else:
            lines = report.report_lines(findings, everything=not quiet)
            for line in (*lines, *([""] if lines else []), report.summary(findings)):
                show(line)
    if count(findings, Rating.PROBLEM):
        raise click.exceptions.Exit(FAILED)


def _findings(joined: ExitStack) -> Iterator[Diagnosis]:
    """Run the checks; ``joined`` closes the connection after the report."""
    from navette.cli.doctor.look import look
    from navette.cli.doctor.machine import check_machine, stopped
    from navette.cli.doctor.network import NETWORK, check_network, look_at_network
    from navette.cli.doctor.processes import processes
    from navette.cli.doctor.up_checks import check_supervised, services_here
    from navette.errors import NetworkError

    joined.enter_context(_quiet())
    # Before connecting: without a router, this process becomes the router.
    network = look_at_network()
    stops = any(router.is_stopped for router in network.routers)
    if stops or network.is_out_of_reach:
        yield from check_network(network, None)
        yield from check_machine()
        return
    try:
        here = joined.enter_context(connect())
        domain = here.context.get_domain_id()
        known = {} if network.is_alone else network.nodes or {}
        published = network.published.get(domain, {})
        seen = look(here, known.get(domain, ()), published)
    except click.exceptions.Exit as end:  # the reason is on standard error already
        if not isinstance(end.__context__, NetworkError):
            raise
        yield from check_network(network, None)
        yield Diagnosis(Rating.PROBLEM, NETWORK, "connection", str(end.__context__))
    else:
        yield from check_network(network, domain)
        yield from stopped(processes(), os.getpid())
        yield from _check_running(seen)
    yield from check_supervised(services_here())
    yield from check_machine()


@contextmanager
def _quiet() -> Iterator[None]:
    """Suppress the transport's warnings: the report contains them."""
    logger = logging.getLogger("navette.transports")
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(before)


def _check_running(seen: "Snapshot") -> Iterator[Diagnosis]:
    from navette.cli.doctor.graph_checks import (
        check_nodes,
        check_services,
        check_topics,
    )
    from navette.cli.doctor.state_checks import check_stages, check_time

    for check in (check_nodes, check_topics, check_services, check_time, check_stages):
        yield from check(seen)
