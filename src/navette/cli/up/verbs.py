"""``navette up``, ``down``, ``ps``, ``logs`` and ``restart``."""

import os
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.options import Argument, Option
from navette.cli.output import show, show_json
from navette.cli.stderr import note
from navette.errors import NavetteError
from navette.files.runs import live_runs, shares, stay_shared

if TYPE_CHECKING:  # imported when a verb is called: completion must be fast
    from navette.cli.up.config import ProjectConfig
    from navette.supervisor.client import SupervisorClient
    from navette.supervisor.log_store import LogReader
    from navette.supervisor.project import Project

_FAILED = 1
_INTERRUPTED = 130
_DOWN_TIMEOUT_S = 60.0
_POLL_S = 0.1


def complete_services(incomplete: str) -> list[str]:
    """Complete the name of a service in the project's file."""
    from navette.cli.up.config import read_config

    try:
        names = read_config(_project(None), {}).names
    except NavetteError:
        return []  # the command reports the error
    return [name for name in names if name.startswith(incomplete)]


def complete_running_services(incomplete: str) -> list[str]:
    """Complete the name of a service that is up."""
    try:
        names = [each["service"] for each in _client(_project(None)).status()]
    except NavetteError:
        return []
    return [name for name in names if name.startswith(incomplete)]


Words = Annotated[
    list[str] | None,
    Argument(
        metavar="SERVICE | NAME:=VALUE",
        help="Services (default: all), and values for the arguments of the file.",
        complete=complete_services,
    ),
]
Services = Annotated[
    list[str] | None,
    Argument(
        metavar="SERVICE",
        help="Services (default: all of the project).",
        complete=complete_running_services,
    ),
]
File = Annotated[
    Path | None,
    Option(
        "--file",
        "-f",
        metavar="FILE",
        help="The project's file (default: navette.yaml in this folder or above, else "
        "the built-in services sim, robot and viewer).",
    ),
]
Timeout = Annotated[
    float,
    Option(metavar="S", min=0, help="How long to wait for readiness, in seconds."),
]
Watch = Annotated[
    bool,
    Option(
        "--watch",
        "-w",
        help="Stay, show the output, and restart a service when its files change.",
    ),
]


def up(
    words: Words = None,
    file: File = None,
    attach: Annotated[
        bool,
        Option(
            "--attach",
            "-a",
            help="Stay, show the output, and stop the services on Ctrl-C.",
        ),
    ] = False,
    watch: Watch = False,
    tree: Annotated[
        Path | None,
        Option(metavar="FILE.xml", help="Same as tree:=FILE.xml: the behaviour tree."),
    ] = None,
    timeout: Timeout = 60.0,
) -> None:
    """Start services; each of their nodes is a supervised process.

    Returns as soon as all are ready. The services run until navette down; arguments
    (NAME:=VALUE) stay set until all services are down. Exit code 1: a process failed or
    was not ready in time.
    """
    stay_shared()
    project = _project(file)
    words = [*(words or ()), *([f"tree:={tree.resolve()}"] if tree else ())]
    config, names = _read(project, words)
    specs = config.specs(names or config.names)
    client = _client(project)
    up_before = {each["service"] for each in client.status()}
    started = [s.name for s in specs if s.name not in up_before or s.name in names]
    reader = _reader(project, started)
    reader.last(0)
    client.up(specs, config.arguments)
    _warn_of_shared_domain(client)
    try:
        _await_ready(client, [s.name for s in specs], timeout, stay=attach or watch)
        if watch:
            _watch_files(client, words)
        elif attach:
            _follow(reader)
    except KeyboardInterrupt:
        if attach:
            _stop(client, started)
        else:
            note("the services keep running; navette down stops them")
        raise click.exceptions.Exit(_INTERRUPTED) from None
    finally:
        reader.close()


def restart(
    words: Words = None,
    file: File = None,
    watch: Watch = False,
    timeout: Timeout = 60.0,
) -> None:
    """Stop services and start them again, with the present content of the file."""
    stay_shared()
    project = _project(file)
    config, names = _read(project, words or [])
    client = _client(project)
    chosen = names or [each["service"] for each in client.status()] or config.names
    known = [name for name in chosen if name in config.services]
    specs = [spec for spec in config.specs(known or chosen) if spec.name in chosen]
    client.restart(specs, config.arguments)
    _await_ready(client, chosen, timeout, stay=watch)
    if watch:
        _watch_files(client, words or [])


def down(services: Services = None, file: File = None) -> None:
    """Stop services, dependents first."""
    _stop(_client(_project(file)), services or None)


def ps(
    file: File = None,
    all_projects: Annotated[
        bool, Option("--all", "-a", help="List the processes of all projects.")
    ] = False,
    as_json: Annotated[
        bool, Option("--json", help="Print a JSON list of processes.")
    ] = False,
) -> None:
    """List running robots, and the processes of services.

    Robots are the runs of navette demo, sim and explore, except those on the network
    that all programs share (--share, ROS_DOMAIN_ID): see navette node list. Each
    process of the services of navette up has its state, pid, time, CPU, memory and
    restarts.
    """
    from navette.cli.runs import run_record, show_runs
    from navette.cli.up.view import as_record, show_processes
    from navette.supervisor.status import process_statuses
    from navette.supervisor.usage import usage_of

    clients = _all_clients() if all_projects else [_client(_project(file))]
    runs = live_runs()
    records: list[dict[str, object]] = [run_record(run) for run in runs]
    if runs and not as_json:
        show_runs(runs)
    for client in clients:
        found = process_statuses(client.status())
        usage = usage_of(each.pid for each in found if each.pid)
        if as_json:
            folder = str(client.project.folder)
            records += [as_record(each, folder, usage) for each in found]
            continue
        if runs and found:
            show()
        if all_projects and found:
            show(f"{client.project.folder}")
        if found:
            show_processes(found, usage)
            _note_log_problem(client)
        elif not all_projects and not runs:
            _show_nothing_up(client)
    if as_json:
        show_json(records)


def logs(
    services: Services = None,
    file: Annotated[
        Path | None, Option("--file", metavar="FILE", help="The project's file.")
    ] = None,
    follow: Annotated[
        bool, Option("--follow", "-f", help="Keep printing new output.")
    ] = False,
    lines: Annotated[
        int, Option("--lines", "-n", min=0, help="Number of last lines; 0: all.")
    ] = 100,
    as_json: Annotated[bool, Option("--json", help="Print each line as JSON.")] = False,
) -> None:
    """Print the output of the services' processes, interleaved in order of time."""
    from navette.cli.up.view import LogView

    project = _project(file)
    view = LogView(as_json=as_json)
    reader = _reader(project, services or [])
    try:
        found = reader.last(lines or None)
        view.show(found)
        if not found:
            _show_no_output(project, services or [])
        _note_log_problem(_client(project))
        pause = threading.Event()
        while follow:
            pause.wait(_POLL_S)
            view.show(reader.new())
    except KeyboardInterrupt:
        pass  # ends --follow
    finally:
        reader.close()


def _note_log_problem(client: "SupervisorClient") -> None:
    problem = client.log_problem()
    if problem:
        note(f"the log in {client.project.state} is incomplete: {problem}")


def _project(file: Path | None) -> "Project":
    if os.name != "posix":
        raise NavetteError(
            "services need Linux or macOS; on this system use navette launch"
        )
    from navette.supervisor.project import find_project

    return find_project(Path.cwd(), file)


def _read(
    project: "Project", words: Sequence[str]
) -> "tuple[ProjectConfig, list[str]]":
    """Return the project's file and the names of services among the words."""
    from navette.cli.up.config import read_config
    from navette.ros2.launch import parse_launch_arguments

    arguments = parse_launch_arguments(word for word in words if ":=" in word)
    names = list(dict.fromkeys(word for word in words if ":=" not in word))
    previous = _client(project).arguments()
    config = read_config(project, arguments, previous)
    kept = config.arguments.keys() & (previous.keys() - arguments.keys())
    if kept:
        texts = (f"{name}:={config.arguments[name]}" for name in sorted(kept))
        note(f"arguments kept from the last command: {' '.join(texts)}")
    return config, names


def _client(project: "Project") -> "SupervisorClient":
    from navette.supervisor.client import SupervisorClient

    return SupervisorClient(project)


def _all_clients() -> "list[SupervisorClient]":
    from navette.supervisor.client import known_projects

    return [_client(project) for project in known_projects()]


def _await_ready(
    client: "SupervisorClient", names: Sequence[str], timeout_s: float, *, stay: bool
) -> None:
    """Show the start of services; exit with an error if one fails or is late."""
    from navette.cli.up.view import Progress, show_addresses, show_failure
    from navette.supervisor.status import last_output, until_settled

    found = Progress().show(until_settled(client, names, timeout_s))
    failed = [each for each in found if each.is_in_trouble]
    for each in failed:
        show_failure(each, last_output(client.project, each))
    show_addresses(last_output(client.project, each) for each in found)
    late = [each.label for each in found if not each.is_settled and not failed]
    if late:
        note(f"not ready within {timeout_s:g} s: {', '.join(late)}")
    if (failed or late) and not stay:
        raise click.exceptions.Exit(_FAILED)


def _warn_of_shared_domain(client: "SupervisorClient") -> None:
    """Warn of another project in the same domain: it may drive this robot."""
    from navette.supervisor.status import projects_in_same_domain

    for domain, other in projects_in_same_domain(client, _all_clients()):
        note(
            f"{other.folder} is up in domain {domain} too: the nodes of both projects "
            "see each other. To separate them, set another ROS_DOMAIN_ID and another "
            "port of the live view"
        )


def _stop(client: "SupervisorClient", names: Sequence[str] | None) -> None:
    from navette.cli.up.view import Progress
    from navette.supervisor.service_config import ProcessState
    from navette.supervisor.status import process_statuses, until_down

    initial = [
        each
        for each in process_statuses(client.down(names))
        if names is None or each.service in names
    ]
    if not initial:
        note(f"nothing is up in {client.project.folder}")
    steps = until_down(client, names, _DOWN_TIMEOUT_S, initial)
    left = [s.label for s in Progress(ProcessState.RUNNING).show(steps) if s.pid]
    if left:
        note(f"still running after {_DOWN_TIMEOUT_S:g} s: {', '.join(left)}")
        raise click.exceptions.Exit(_FAILED)


def _follow(reader: "LogReader") -> None:
    """Show new output until Ctrl-C."""
    from navette.cli.up.view import LogView

    view, pause = LogView(), threading.Event()
    while True:
        view.show(reader.new())
        pause.wait(_POLL_S)


def _watch_files(client: "SupervisorClient", words: Sequence[str]) -> None:
    """Show new output and restart services whose files change, until Ctrl-C."""
    from navette.cli.up.view import LogView
    from navette.cli.up.watch import ServiceWatch

    watch = ServiceWatch(client, read=lambda: _read(client.project, words))
    reader, view, pause = _reader(client.project, []), LogView(), threading.Event()
    note(f"watching {watch.describe()}; Ctrl-C ends the watch, not the services")
    try:
        reader.last(0)
        while True:
            pause.wait(_POLL_S)
            view.show(reader.new())
            watch.poll()
    except KeyboardInterrupt:
        pass  # ends --watch
    finally:
        reader.close()


def _reader(project: "Project", services: Sequence[str]) -> "LogReader":
    from navette.supervisor.log_store import LogReader

    chosen = set(services)
    return LogReader(
        project.state,
        accept=lambda line: (
            not chosen or line.service in chosen or line.label in chosen
        ),
    )


def _show_no_output(project: "Project", services: Sequence[str]) -> None:
    """Print which processes have output."""
    reader = _reader(project, [])
    labels = sorted({line.label for line in reader.last(None)})
    reader.close()
    source = f" of {', '.join(services)}" if services else ""
    known = f" (there is output of {', '.join(labels)})" if labels else ""
    note(f"no output{source} in {project.folder}{known}")


def _show_nothing_up(client: "SupervisorClient") -> None:
    from navette.supervisor.client import killed_supervisor

    show(f"nothing is up in {client.project.folder}")
    if shares():
        note(
            "robots on the shared network, which ROS_DOMAIN_ID, NAVETTE_ROUTER or "
            "NAVETTE_RUN=shared selects, are not listed: navette node list"
        )
    pid = killed_supervisor(client.project)
    if pid is not None:
        note(f"its supervisor (pid {pid}) was killed; its processes were ended")
    elsewhere = [other.project.folder for other in _all_clients() if other.status()]
    if elsewhere:
        note(
            f"up in other folders: {', '.join(map(str, elsewhere))} (navette ps --all)"
        )
