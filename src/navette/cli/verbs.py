"""The verbs that are imported when they are called, in the order of the help."""

from navette.cli.commands import LazyCommand

# A test compares each text with the first line of the verb's own help.
VERBS = (
    LazyCommand(
        "run",
        "navette.cli.run:run",
        "Run unmodified ROS 2 programs without ROS 2.",
        # Options after the program's name belong to the program.
        settings={"allow_interspersed_args": False},
    ),
    LazyCommand(
        "bench",
        "navette.cli.bench:bench",
        "Drive a set of worlds, and measure success, contacts, time and score.",
    ),
    LazyCommand(
        "launch",
        "navette.cli.launch:launch",
        "Run a launch file: all its nodes in this process, or each in its own process.",
    ),
    LazyCommand(
        "up",
        "navette.cli.up.verbs:up",
        "Start services; each of their nodes is a supervised process.",
    ),
    LazyCommand(
        "down",
        "navette.cli.up.verbs:down",
        "Stop services, dependents first.",
    ),
    LazyCommand(
        "restart",
        "navette.cli.up.verbs:restart",
        "Stop services and start them again, with the present content of the file.",
    ),
    LazyCommand(
        "ps",
        "navette.cli.up.verbs:ps",
        "List the processes of services: state, pid, time, CPU, memory, restarts.",
    ),
    LazyCommand(
        "logs",
        "navette.cli.up.verbs:logs",
        "Print the output of the services' processes, interleaved in order of time.",
    ),
    LazyCommand(
        "teleop",
        "navette.cli.teleop:teleop",
        "Drive a robot with the keyboard.",
    ),
    LazyCommand(
        "stop",
        "navette.cli.stop:stop",
        "Stop the robot at once; it stays stopped until --release.",
    ),
    LazyCommand(
        "cancel",
        "navette.cli.cancel:cancel",
        "Cancel every goal: the robot stops and waits for the next one.",
    ),
    LazyCommand(
        "explore",
        "navette.cli.explore:explore",
        "Map an unknown world: in the simulator, or with the running robot.",
    ),
    LazyCommand(
        "tree",
        "navette.cli.tree:tree",
        "Watch the behaviour tree of the running robot, or check a tree file.",
        read_only=True,
    ),
    LazyCommand(
        "topic",
        "navette.cli.topic:topic",
        "List, inspect, print and measure topics, and publish messages.",
        read_only=True,
    ),
    LazyCommand(
        "node", "navette.cli.node:node", "List and inspect nodes.", read_only=True
    ),
    LazyCommand(
        "param",
        "navette.cli.param:param",
        "Get, set, list, describe, dump and load parameters of nodes.",
        read_only=True,
    ),
    LazyCommand(
        "service",
        "navette.cli.service:service",
        "List, inspect and print services, and call them.",
        read_only=True,
    ),
    LazyCommand(
        "action",
        "navette.cli.action:action",
        "List and inspect actions, and send goals.",
        read_only=True,
    ),
    LazyCommand(
        "interface",
        "navette.cli.interface:interface",
        "Show definitions of messages, services and actions.",
        read_only=True,
    ),
    LazyCommand(
        "lifecycle",
        "navette.cli.lifecycle:lifecycle",
        "Inspect managed nodes and change their state.",
        read_only=True,
    ),
    LazyCommand(
        "component",
        "navette.cli.component:component",
        "Load nodes into running containers and unload them.",
        read_only=True,
    ),
    LazyCommand(
        "bag",
        "navette.cli.bag:bag",
        "Record, play, inspect, repair and edit recordings (.mcap, .bag, .db3).",
    ),
    LazyCommand(
        "pkg",
        "navette.cli.pkg:pkg",
        "Create and find packages; packages of the workspace need no build.",
    ),
    LazyCommand(
        "keys",
        "navette.cli.keys:keys",
        "Create keys and certificates for mutual TLS.",
    ),
    LazyCommand(
        "doctor",
        "navette.cli.doctor:doctor",
        "Find problems of this system and suggest what to do.",
        read_only=True,
    ),
    LazyCommand(
        "completion",
        "navette.cli.completion:completion",
        "Print or install the shell completion script.",
        read_only=True,
    ),
)
