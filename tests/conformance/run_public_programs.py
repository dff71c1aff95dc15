"""Run the rclpy programs of ros2/examples and ros2/demos, unmodified.

    python tests/conformance/run_public_programs.py FOLDER [WORD]

FOLDER holds checkouts of both repositories; WORD picks the cases whose name has it.
Prints a line a case: whether the program printed what it prints on ROS 2 and ended as
it should. None of the programs is part of this repository.
"""

# ruff: noqa: T201 - it prints a report

import sys
from dataclasses import dataclass
from pathlib import Path

from program_run import ProgramRun, run_until_printed

#: Stands in for a C++ demo: a node that takes any parameter.
BLACKBOARD = "programs/parameter_blackboard.py"

PUBLISHING = [r'Publishing: "Hello World: 0"', r'Publishing: "Hello World: 1"']
LISTENER_LINES = [r'I heard: "Hello World: \d+"'] * 2
SUM = r"Result of add_two_ints: for 41 \+ 1 = 42"
INCOMING = r"Incoming request\na: 41 b: 1"
SEQUENCE = r"array\('i', \[0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55\]\)"
FEEDBACK = r"array\('i', \[0, 1, 1, 2\]\)"


@dataclass(frozen=True)
class Case:
    """Programs by path suffix, each followed by its arguments."""

    programs: tuple[str, ...]
    expected: list[str]
    timeout_s: float = 6.0
    forbidden: str = r"Traceback \(most recent"

    @property
    def name(self) -> str:
        return " + ".join(text.split()[0] for text in self.programs)


def _pairs() -> list[Case]:
    publishers = ("local_function", "member_function", "old_school")
    subscribers = ("lambda", "member_function", "old_school")
    topics = [
        Case(
            (f"minimal_publisher/publisher_{p}.py", f"subscriber_{s}.py"),
            [*PUBLISHING[:1], *LISTENER_LINES],
        )
        for p, s in zip(publishers, subscribers, strict=True)
    ]
    clients = ("", "_async", "_async_callback", "_async_member_function")
    services = ("service", "service_member_function") * 2
    calls = [
        Case((f"minimal_service/{s}.py", f"minimal_client/client{c}.py"),
             [INCOMING, SUM])
        for c, s in zip(clients, services, strict=True)
    ]  # fmt: skip
    return topics + calls


def _executors() -> list[Case]:
    return [
        Case(
            ("rclpy_executors/composed.py",),
            [r"Publishing: \"Hello World: 0\"", r"I heard: \"Hello World: 0\""],
        ),
        Case(
            ("rclpy_executors/callback_group.py",),
            [r"Publishing: \"Hello World: 0\"", r"I heard: \"Hello World: 1\""],
        ),
        # Ten messages at 10 Hz, then one for each token of the bucket.
        Case(("rclpy_executors/custom_callback_group.py",), [r"Hello World: 12"]),
        Case(
            ("rclpy_executors/custom_executor.py",),
            [r"Publishing: \"Hello World: 0\"", r"I heard: \"Hello World: 1\""],
        ),
        Case(
            ("rclpy_guard_conditions/trigger_guard_condition.py",),
            [
                "waiting for 'spin_once' to finish",
                "timer callback triggered guard condition",
                "'spin_once' finished!",
                "guard callback called",
            ],
            8.0,
        ),
        Case(("pointcloud_publisher/pointcloud_publisher.py",), [], 3.0),
    ]


def _actions() -> list[Case]:
    servers = ("server", "server_not_composable", "server_defer",
               "server_queue_goals", "server_single_goal")  # fmt: skip
    whole = [r"Executing goal\.\.\.", FEEDBACK, rf"Goal succeeded! Result: {SEQUENCE}"]
    return [
        *(
            Case(
                (f"minimal_action_server/{server}.py", f"action_client/{client}.py"),
                whole,
                18.0,
            )
            for server, client in zip(
                servers, ["client", "client_not_composable"] * 2 + ["client"],
                strict=True,
            )
        ),
        Case(
            ("minimal_action_server/server.py", "action_client/client_cancel.py"),
            ["Goal accepted", "Canceling goal", "Goal successfully canceled"],
            12.0,
        ),
        Case(
            ("minimal_action_server/server.py", "action_client/client_asyncio.py"),
            ["result .* and status flag 4", "A\\) result", "B\\) result"],
            50.0,
        ),
        Case(
            ("fibonacci_action_server.py", "fibonacci_action_client.py"),
            ["Goal accepted", FEEDBACK, f"Result: {SEQUENCE}"],
            18.0,
        ),
    ]  # fmt: skip


def _demos() -> list[Case]:
    return [
        Case(
            ("demo_nodes_py/topics/talker.py", "demo_nodes_py/topics/listener.py"),
            ['Publishing: "Hello World: 0"', r"I heard: \[Hello World: 0\]"],
        ),
        Case(
            ("topics/talker_qos.py -n 2", "topics/listener_qos.py -n 2"),
            [r"(Publishing|I heard): .*Hello World: 0", r"Hello World: 1"],
        ),
        Case(
            ("topics/talker_qos.py --reliable", "topics/listener_qos.py --reliable"),
            ["Reliable", r"I heard: \[Hello World: 0\]"],
        ),
        Case(
            ("demo_nodes_py/topics/talker.py", "topics/listener_serialized.py"),
            [r"I heard: .*Hello World: \d"],
        ),
        Case(
            ("services/add_two_ints_server.py", "services/add_two_ints_client.py"),
            [r"Incoming request\na: 2 b: 3", "Result of add_two_ints: 5"],
        ),
        Case(
            ("services/add_two_ints_server.py",
             "services/add_two_ints_client_async.py"),
            ["Result of add_two_ints: 5"],
        ),
        Case(("parameters/set_parameters_callback.py",), [], 2.0),
        Case(
            ("parameters/async_param_client.py", BLACKBOARD),
            ["int_parameter:", "successful: True", "int_parameter: 10"],
        ),
        Case(("services/introspection.py",), ["Result of add_two_ints: 5"]),
        Case(
            ("events/matched_event_detect.py",),
            [
                "First subscription is connected",
                "changed number of connected subscription is 1 and .* is 2",
                "changed number of connected subscription is -1 and .* is 1",
                "Last subscription is disconnected",
                "First publisher is connected",
                "changed number of connected publisher is 1 and .* is 2",
                "changed number of connected publisher is -1 and .* is 1",
                "Last publisher is disconnected",
            ],
        ),
        Case(
            ("logging/use_logger_service.py",),
            [
                "Output 1 with INFO", "Current logger level: 0",
                "Output 2 with DEBUG", "Current logger level: 10",
                "Output 3 with WARN", "Current logger level: 30",
                "Output 4 with ERROR", "Current logger level: 40",
            ],
        ),
        Case(("lifecycle_py/talker.py",), [], 2.0),
        Case(
            ("scripts/data_publisher.py sensor --end-after 3 --period 0.2",),
            ["Publishing on topic: sensor_data", 'Publishing: "2"', 'Publishing: "-1"'],
        ),
        Case(
            ("scripts/topic_monitor.py",
             "scripts/data_publisher.py sensor --period 0.2"),
            ["Subscribing to topic: /sensor_data", r"/sensor_data: \d+"],
        ),
    ]  # fmt: skip


def _qos() -> list[Case]:
    return [
        Case(
            ("demo_py/deadline.py 600 --publish-for 1500 --pause-for 1500",),
            ["Listener heard", "deadline missed - total 1 delta 1"],
            10.0,
        ),
        Case(
            ("demo_py/lifespan.py 1000 --publish-count 3 --subscribe-after 3000",),
            ["Publishing: 'Talker says 2'", "Listener starting up"],
            8.0,
            forbidden="Listener heard",  # all had expired by then
        ),
        Case(
            ("demo_py/liveliness.py 1000 --kill-publisher-after 1500",),
            ["alive_count: 1", "Listener heard", "alive_count: 0"],
            10.0,
        ),
        Case(
            ("demo_py/incompatible_qos.py durability",),
            ["incompatible qos - total 1 delta 1 last_policy_kind: "],
            10.0,
        ),
        Case(
            ("demo_py/incompatible_qos.py reliability",),
            ["incompatible qos - total 1 delta 1 last_policy_kind: "],
            10.0,
        ),
        Case(("demo_py/message_lost_listener.py",), [], 2.0),
        Case(
            ("demo_py/qos_overrides_talker.py", "demo_py/qos_overrides_listener.py"),
            [r"I heard: \[Hello World: 1\]"],
        ),
    ]


def _words(folder: Path, case: Case) -> list[str]:
    words: list[str] = []
    for text in case.programs:
        end, *arguments = text.split()
        (path,) = [
            each
            for each in (*folder.rglob(Path(end).name), Path(__file__).parent / end)
            if str(each).endswith(end) and each.is_file()
        ]
        words += [*(["--with"] if words else []), str(path), *arguments]
    return words


def _report(case: Case, run: ProgramRun) -> None:
    print(f"{'ok  ' if run.is_good else 'FAIL'} {case.name}", flush=True)
    if not run.is_good:
        for fault in run.faults():
            print(f"       {fault}")
        for line in run.output.splitlines()[-4:]:
            print(f"       | {line[:160]}")


def main() -> int:
    folder, wanted = Path(sys.argv[1]), "".join(sys.argv[2:3])
    cases = [*_pairs(), *_executors(), *_actions(), *_demos(), *_qos()]
    chosen = [case for case in cases if wanted in case.name]
    good = 0
    for case in chosen:
        run = run_until_printed(
            _words(folder, case),
            case.expected,
            case.timeout_s,
            case.forbidden,
            packages=str(folder.resolve()),
        )
        good += run.is_good
        _report(case, run)
    print(f"{good} of {len(chosen)}")
    return 0 if good == len(chosen) else 1


if __name__ == "__main__":
    sys.exit(main())
