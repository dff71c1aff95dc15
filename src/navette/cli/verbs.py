"""The verbs that are imported when they are called, in the order of the help."""

from navette.cli.commands import LazyCommand

# Panels of the help; demo and sim are declared in app.py.
DRIVE = "Drive"
PROGRAMS = "Programs and services"
INSPECT = "Inspect"
SETTINGS = "Recordings and settings"

# A test compares each text with the first line of the verb's own help.
VERBS = (
    LazyCommand(
        "explore",
        "navette.cli.explore:explore",
        "Map an unknown world: in the simulator, or with the running robot.",
        panel=DRIVE,
    ),
    LazyCommand(
        "teleop",
        "navette.cli.teleop:teleop",
        "Drive a robot with the keyboard.",
        panel=DRIVE,
    ),
    LazyCommand(
        "stop",
        "navette.cli.stop:stop",
        "Stop the robot at once; it stays stopped until --release.",
        panel=DRIVE,
    ),
    LazyCommand(
        "cancel",
        "navette.cli.cancel:cancel",
        "Cancel every goal: the robot stops and waits for the next one.",
        panel=DRIVE,
    ),
    LazyCommand(
        "tree",
        "navette.cli.tree:tree",
        "Watch the behaviour tree of the running robot, or check a tree file.",
        read_only=True,
        panel=DRIVE,
    ),
    LazyCommand(
        "map",
        "navette.cli.map:map_",
        "Save, show and convert maps.",
        panel=DRIVE,
    ),
    LazyCommand(
        "slam",
        "navette.cli.slam:slam",
        "Build a map from a recording: scans and odometry in, map and trajectory out.",
        panel=DRIVE,
    ),
    LazyCommand(
        "bench",
        "navette.cli.bench:bench",
        "Drive a set of worlds and measure success, contacts, time and score.",
        panel=DRIVE,
    ),
    LazyCommand(
        "run",
        "navette.cli.run:run",
        "Run unmodified ROS 2 programs without ROS 2.",
        # Options after the program's name belong to the program.
        settings={"allow_interspersed_args": False},
        panel=PROGRAMS,
    ),
    LazyCommand(
        "launch",
        "navette.cli.launch:launch",
        "Run a launch file: all its nodes in this process, or each in its own process.",
        panel=PROGRAMS,
    ),
    LazyCommand(
        "up",
        "navette.cli.up.verbs:up",
        "Start services; each of their nodes is a supervised process.",
        panel=PROGRAMS,
    ),
    LazyCommand(
        "ps",
        "navette.cli.up.verbs:ps",
        "List running robots, and the processes of services.",
        panel=PROGRAMS,
    ),
    LazyCommand(
        "logs",
        "navette.cli.up.verbs:logs",
        "Print the output of the services' processes, interleaved in order of time.",
        panel=PROGRAMS,
    ),
    LazyCommand(
        "restart",
        "navette.cli.up.verbs:restart",
        "Stop services and start them again, with the present content of the file.",
        panel=PROGRAMS,
    ),
    LazyCommand(
        "down",
        "navette.cli.up.verbs:down",
        "Stop services, dependents first.",
        panel=PROGRAMS,
    ),
    LazyCommand(
        "pkg",
        "navette.cli.pkg:pkg",
        "Create and find packages; packages of the workspace need no build.",
        panel=PROGRAMS,
    ),
    LazyCommand(
        "topic",
        "navette.cli.topic:topic",
        "List, inspect, print and measure topics, and publish messages.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "node",
        "navette.cli.node:node",
        "List and inspect nodes.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "param",
        "navette.cli.param:param",
        "Get, set, list, describe, dump and load parameters of nodes.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "service",
        "navette.cli.service:service",
        "List, inspect and print services, and call them.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "action",
        "navette.cli.action:action",
        "List and inspect actions, and send goals.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "interface",
        "navette.cli.interface:interface",
        "Show definitions of messages, services and actions.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "lifecycle",
        "navette.cli.lifecycle:lifecycle",
        "Inspect managed nodes and change their state.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "component",
        "navette.cli.component:component",
        "Load nodes into running containers and unload them.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "doctor",
        "navette.cli.doctor:doctor",
        "Find problems of this system and suggest what to do.",
        read_only=True,
        panel=INSPECT,
    ),
    LazyCommand(
        "bag",
        "navette.cli.bag:bag",
        "Record, play, inspect, repair and edit recordings (.mcap, .bag, .db3).",
        panel=SETTINGS,
    ),
    LazyCommand(
        "keys",
        "navette.cli.keys:keys",
        "Create keys and certificates for mutual TLS.",
        panel=SETTINGS,
    ),
    LazyCommand(
        "completion",
        "navette.cli.completion:completion",
        "Print or install the shell completion script.",
        read_only=True,
        panel=SETTINGS,
    ),
)
