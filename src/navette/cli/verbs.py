"""The verbs that are imported when they are called, in the order of the help."""

import typer

from navette.cli.lazy import Later


def _run(app: typer.Typer) -> None:
    from navette.cli.run import run

    # What stands behind the program's name is the program's.
    app.command(context_settings={"allow_interspersed_args": False})(run)


def _launch(app: typer.Typer) -> None:
    from navette.cli.launch import launch

    app.command()(launch)


def _up(app: typer.Typer) -> None:
    from navette.cli.up.verbs import down, logs, ps, restart, up

    for command in (up, down, restart, ps, logs):
        app.command()(command)


def _teleop(app: typer.Typer) -> None:
    from navette.cli.teleop import teleop

    app.command()(teleop)


def _topic(app: typer.Typer) -> None:
    from navette.cli.topic import topic

    app.add_typer(topic)


def _node(app: typer.Typer) -> None:
    from navette.cli.node import node

    app.add_typer(node)


def _param(app: typer.Typer) -> None:
    from navette.cli.param import param

    app.add_typer(param)


def _service(app: typer.Typer) -> None:
    from navette.cli.service import service

    app.add_typer(service)


def _action(app: typer.Typer) -> None:
    from navette.cli.action import action

    app.add_typer(action)


def _interface(app: typer.Typer) -> None:
    from navette.cli.interface import interface

    app.add_typer(interface)


def _lifecycle(app: typer.Typer) -> None:
    from navette.cli.lifecycle import lifecycle

    app.add_typer(lifecycle)


def _component(app: typer.Typer) -> None:
    from navette.cli.component import component

    app.add_typer(component)


def _bag(app: typer.Typer) -> None:
    from navette.cli.bag import bag

    app.add_typer(bag)


def _pkg(app: typer.Typer) -> None:
    from navette.cli.pkg import pkg

    app.add_typer(pkg)


def _keys(app: typer.Typer) -> None:
    from navette.cli.keys import keys

    app.add_typer(keys)


def _doctor(app: typer.Typer) -> None:
    from navette.cli.doctor import doctor

    app.command()(doctor)


def _completion(app: typer.Typer) -> None:
    from navette.cli.completion import completion

    app.command()(completion)


# A test compares the texts with those of the commands themselves.
VERBS = {
    "run": Later("Run ROS 2 programs as they are, without ROS 2.", _run),
    "launch": Later(
        "Run a launch file: all its nodes in this process, or each in its own process.",
        _launch,
    ),
    "up": Later("Start services; each of their nodes is a supervised process.", _up),
    "down": Later("Stop services, dependents first.", _up),
    "restart": Later(
        "Stop services and start them again, with the present content of the file.",
        _up,
    ),
    "ps": Later(
        "List the processes of services: state, pid, time, CPU, memory, restarts.", _up
    ),
    "logs": Later(
        "Print the output of the services' processes, interleaved in order of time.",
        _up,
    ),
    "teleop": Later("Drive a robot with the keys of this terminal.", _teleop),
    "topic": Later(
        "Look into topics: list, info, echo, hz, bw, delay; and publish.",
        _topic,
        only_looks=True,
    ),
    "node": Later("Look at the nodes that run.", _node, only_looks=True),
    "param": Later(
        "Read and change the parameters of nodes that run.", _param, only_looks=True
    ),
    "service": Later(
        "Look into services: list, type, find, info, echo; and call them.",
        _service,
        only_looks=True,
    ),
    "action": Later(
        "Look into actions: list, type, find, info; and send goals.",
        _action,
        only_looks=True,
    ),
    "interface": Later(
        "Show messages, services and actions, and how they are defined.",
        _interface,
        only_looks=True,
    ),
    "lifecycle": Later(
        "Look at managed nodes, and take them from state to state.",
        _lifecycle,
        only_looks=True,
    ),
    "component": Later(
        "Load nodes into containers that run, and take them out.",
        _component,
        only_looks=True,
    ),
    "bag": Later(
        "Recordings (.mcap, .bag, .db3): record, play, look into, repair, rework.", _bag
    ),
    "pkg": Later(
        "Make packages and find them: in the workspace by folder, without building.",
        _pkg,
    ),
    "keys": Later("Keys and certificates for links with mutual TLS.", _keys),
    "doctor": Later(
        "Find what is wrong here, and say what to do about it.",
        _doctor,
        only_looks=True,
    ),
    "completion": Later(
        "Teach the shell to complete navette's words at Tab.",
        _completion,
        only_looks=True,
    ),
}
