"""``navette up``, ``down``, ``ps``, ``logs``, ``restart``: modules of a project."""

import os
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from navette.cli.output import note, show, show_json
from navette.errors import NavetteError

if TYPE_CHECKING:
    from navette.supervisor.client import Client
    from navette.supervisor.log_book import LogReader
    from navette.supervisor.project import Project
    from navette.supervisor.reading import ProjectFile
    from navette.supervisor.session import ProcessView
    from navette.supervisor.usage import Usage

_FAILED = 1
_INTERRUPTED = 130
_DOWN_S = 60.0
_LOOK_S = 0.1


def complete_modules(incomplete: str) -> list[str]:
    """Names of the modules of the project's file, for the shell."""
    from navette.supervisor.reading import read_project

    try:
        names = read_project(_project(None), {}).names
    except NavetteError:
        return []  # it is said when the command is given
    return [name for name in names if name.startswith(incomplete)]


def complete_running_modules(incomplete: str) -> list[str]:
    """Names of the modules that are up, for the shell."""
    try:
        names = [module["module"] for module in _client(_project(None)).status()]
    except NavetteError:
        return []
    return [name for name in names if name.startswith(incomplete)]


Words = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="MODULE | NAME:=VALUE",
        help="Modules, all if none is named, and values for the file's arguments.",
        autocompletion=complete_modules,
    ),
]
Modules = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="MODULE",
        help="All of the project, if none is named.",
        autocompletion=complete_running_modules,
    ),
]
File = Annotated[
    Path | None,
    typer.Option(
        "--file",
        "-f",
        metavar="FILE",
        help="The project's file; by default navette.yaml here or in a folder above, "
        "or the built-in modules sim, robot and viewer.",
    ),
]
Timeout = Annotated[
    float, typer.Option(metavar="S", help="How long to wait until all are ready.")
]
Watch = Annotated[
    bool,
    typer.Option(
        "--watch",
        "-w",
        help="Stay, show the output, and restart a module when its files change.",
    ),
]


def up(
    words: Words = None,
    file: File = None,
    attach: Annotated[
        bool,
        typer.Option(
            "--attach", "-a", help="Stay and show the output; Ctrl-C ends the modules."
        ),
    ] = False,
    watch: Watch = False,
    timeout: Timeout = 60.0,
) -> None:
    """Start modules, each of its nodes a process that is kept running.

    Ends as soon as all are ready; the modules stay until navette down, and arguments
    (NAME:=VALUE) hold for whatever is started until all are down. Exit code 1: a
    process ended or was not ready in time.
    """
    project, content, names = _read(words or [], file)
    specs = content.specs(names or content.names)
    client = _client(project)
    up_before = {module["module"] for module in client.status()}
    started = [s.name for s in specs if s.name not in up_before or s.name in names]
    reader = _reader(project, started)
    reader.last(0)
    client.up(specs, content.arguments)
    _tell_neighbours(client)
    try:
        _watch_start(client, [s.name for s in specs], timeout, stay=attach or watch)
        if watch:
            _watch_files(client, words or [], file)
        elif attach:
            _follow(reader)
    except KeyboardInterrupt:
        if attach:
            _end(client, started)
        else:
            note("the modules go on; navette down ends them")
        raise typer.Exit(_INTERRUPTED) from None
    finally:
        reader.close()


def restart(
    words: Words = None,
    file: File = None,
    watch: Watch = False,
    timeout: Timeout = 60.0,
) -> None:
    """End modules and start them anew, as the project's file says now."""
    project, content, names = _read(words or [], file)
    client = _client(project)
    chosen = names or [each["module"] for each in client.status()] or content.names
    known = [name for name in chosen if name in content.modules]
    specs = [spec for spec in content.specs(known or chosen) if spec.name in chosen]
    client.restart(specs, content.arguments)
    _watch_start(client, chosen, timeout, stay=watch)
    if watch:
        _watch_files(client, words or [], file)


def down(modules: Modules = None, file: File = None) -> None:
    """End modules: those that need others first, all if none is named."""
    client = _client(_project(file))
    _end(client, modules or None)


def ps(
    file: File = None,
    all_projects: Annotated[
        bool, typer.Option("--all", "-a", help="Of all folders, not only this one.")
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON list of processes.")
    ] = False,
) -> None:
    """List the modules' processes: state, pid, since when, use, restarts, reason."""
    from navette.cli.modules_view import as_record, show_processes
    from navette.supervisor.session import views

    clients = _all_clients() if all_projects else [_client(_project(file))]
    everything: list[dict[str, object]] = []
    for client in clients:
        found = views(client.status())
        usage = _usage(found)
        if as_json:
            folder = str(client.project.folder)
            everything += [as_record(view, folder, usage) for view in found]
            continue
        if all_projects and found:
            show(f"{client.project.folder}")
        if found:
            show_processes(found, usage)
        elif not all_projects:
            _nothing_is_up(client)
    if as_json:
        show_json(everything)


def logs(
    modules: Modules = None,
    file: Annotated[
        Path | None, typer.Option("--file", metavar="FILE", help="The project's file.")
    ] = None,
    follow: Annotated[
        bool, typer.Option("--follow", "-f", help="Go on as more is written.")
    ] = False,
    lines: Annotated[
        int, typer.Option("--lines", "-n", min=0, help="The last so many; 0: all.")
    ] = 100,
    as_json: Annotated[
        bool, typer.Option("--json", help="A line of JSON for each.")
    ] = False,
) -> None:
    """Print what the modules' processes wrote: all in one, in the order of writing."""
    from navette.cli.modules_view import LogView

    project = _project(file)
    view = LogView(as_json=as_json)
    reader = _reader(project, modules or [])
    try:
        found = reader.last(lines or None)
        view.show(found)
        if not found:
            _tell_who_wrote(project, modules or [])
        pause = threading.Event()
        while follow:
            pause.wait(_LOOK_S)
            view.show(reader.new())
    except KeyboardInterrupt:
        pass  # the way to end it
    finally:
        reader.close()


# -- inside ----------------------------------------------------------------------------


def _project(file: Path | None) -> "Project":
    if os.name != "posix":
        raise NavetteError("modules need Linux or macOS; navette launch works here")
    from navette.supervisor.project import find_project

    return find_project(Path.cwd(), file)


def _read(
    words: Sequence[str], file: Path | None
) -> "tuple[Project, ProjectFile, list[str]]":
    """The project, its file, and the names of modules among the words."""
    from navette.ros2.launch import parse_launch_arguments
    from navette.supervisor.reading import read_project

    project = _project(file)
    arguments = parse_launch_arguments(word for word in words if ":=" in word)
    names = list(dict.fromkeys(word for word in words if ":=" not in word))
    before = _client(project).arguments()
    content = read_project(project, arguments, before)
    kept = content.arguments.keys() & (before.keys() - arguments.keys())
    if kept:
        said = (f"{name}:={content.arguments[name]}" for name in sorted(kept))
        note(f"as before: {' '.join(said)}")
    return project, content, names


def _client(project: "Project") -> "Client":
    from navette.supervisor.client import Client

    return Client(project)


def _all_clients() -> "list[Client]":
    from navette.supervisor.client import known_projects

    return [_client(project) for project in known_projects()]


def _watch_start(
    client: "Client", names: Sequence[str], timeout_s: float, *, stay: bool
) -> None:
    from navette.cli.modules_view import Progress, show_addresses, show_trouble
    from navette.supervisor.session import last_words, until_settled

    found = Progress().show(until_settled(client, names, timeout_s))
    troubled = [view for view in found if view.is_in_trouble]
    for view in troubled:
        show_trouble(view, last_words(client.project, view))
    show_addresses(last_words(client.project, view) for view in found)
    late = [view.label for view in found if not view.is_settled and not troubled]
    if late:
        note(f"not ready after {timeout_s:g} s: {', '.join(late)}")
    if (troubled or late) and not stay:
        raise typer.Exit(_FAILED)


def _tell_neighbours(client: "Client") -> None:
    """Two systems in one domain drive each other's robot."""
    from navette.supervisor.session import neighbours

    for domain, other in neighbours(client, _all_clients()):
        note(
            f"{other.folder} is up in domain {domain} too: these modules meet its "
            "nodes (if that is not meant: another ROS_DOMAIN_ID, and another port of "
            "the live view)"
        )


def _end(client: "Client", names: Sequence[str] | None) -> None:
    from navette.cli.modules_view import Progress
    from navette.supervisor.session import until_down, views
    from navette.supervisor.specs import State

    found = views(client.down(names))
    first = [view for view in found if names is None or view.module in names]
    if not first:
        note(f"nothing is up in {client.project.folder}")
    left = Progress(State.RUNNING).show(until_down(client, names, _DOWN_S, first))
    if any(view.pid for view in left):
        note(f"still there: {', '.join(v.label for v in left if v.pid)}")
        raise typer.Exit(_FAILED)


def _follow(reader: "LogReader") -> None:
    """Show what comes until Ctrl-C."""
    from navette.cli.modules_view import LogView

    view, pause = LogView(), threading.Event()
    while True:
        view.show(reader.new())
        pause.wait(_LOOK_S)


def _watch_files(client: "Client", words: Sequence[str], file: Path | None) -> None:
    """Show the log and restart modules as their files change, until Ctrl-C."""
    from navette.cli.modules_view import LogView
    from navette.cli.modules_watch import ChangeWatch

    watch = ChangeWatch(client, lambda: _read(words, file))
    reader, view, pause = _reader(client.project, []), LogView(), threading.Event()
    note(f"watching {watch.described}; Ctrl-C ends the watching, not the modules")
    try:
        reader.last(0)
        while True:
            pause.wait(_LOOK_S)
            view.show(reader.new())
            watch.look()
    except KeyboardInterrupt:
        pass  # the way to end it
    finally:
        reader.close()


def _reader(project: "Project", modules: Sequence[str]) -> "LogReader":
    from navette.supervisor.log_book import LogReader

    wanted = set(modules)
    return LogReader(
        project.state,
        lambda line: not wanted or line.module in wanted or line.label in wanted,
    )


def _usage(found: "Sequence[ProcessView]") -> "dict[int, Usage]":
    """Process id → what it uses."""
    from navette.supervisor.usage import usage_of

    return usage_of(view.pid for view in found if view.pid)


def _tell_who_wrote(project: "Project", modules: Sequence[str]) -> None:
    """Where there are no lines: whose there are."""
    reader = _reader(project, [])
    labels = {line.label for line in reader.last(None)}
    reader.close()
    who = f"{', '.join(modules)} wrote nothing" if modules else "nothing was written"
    known = f" (there is the log of {', '.join(sorted(labels))})" if labels else ""
    note(f"{who} in {project.folder}{known}")


def _nothing_is_up(client: "Client") -> None:
    from navette.supervisor.client import died

    show(f"nothing is up in {client.project.folder}")
    pid = died(client.project)
    if pid is not None:
        note(f"its supervisor (pid {pid}) was killed, and its processes were ended")
    elsewhere = [other.project.folder for other in _all_clients() if other.status()]
    if elsewhere:
        note(f"elsewhere: {', '.join(map(str, elsewhere))} (navette ps --all)")
