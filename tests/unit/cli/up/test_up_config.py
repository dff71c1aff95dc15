"""``navette.yaml``: valid files, and errors."""

import sys
from pathlib import Path
from typing import Any

import pytest

from navette.cli.up.config import DEFAULT_FILE, read_config
from navette.errors import FileFormatError, InvalidValueError, NavetteError
from navette.supervisor import RestartPolicy
from navette.supervisor.project import Project, find_project
from navette.supervisor.service_config import ServiceConfig

RUN = (sys.executable, "-u", "-m", "navette", "run")


def test_a_node_with_all_keys(bench: Any) -> None:
    bench.write("p:\n  ros__parameters:\n    a: 1\n", "shared.yaml")
    bench.write("p:\n  ros__parameters:\n    b: 1\n", "own.yaml")
    bench.write("", "node.py")
    bench.write(
        """
        arguments: {rate: 5}
        services:
          drive:
            nodes:
              - run: node.py --fast
                name: quick
                node_name: pilot
                namespace: /r1
                arguments: ["$(var rate)", "a b"]
                parameters: {rate_hz: $(var rate), gains: {p: 1.5, on: true}}
                parameter_files: [own.yaml]
                remap: {scan: /lidar}
                environment: {LEVEL: 3, QUIET: true}
                restart: {condition: always, max_attempts: 2, delay_s: 0.1}
                stop_timeout_s: 2
            parameters: {use_sim_time: true}
            parameter_files: [shared.yaml]
            environment: {LEVEL: 1, HERE: $(dirname)}
            restart: no
            watch: [extra]
        """
    )
    (service,) = bench.specs("drive", rate="9")
    (process,) = service.processes
    folder = bench.folder
    assert process.argv == (
        *RUN,
        *("node.py", "--fast", "9", "a b", "--ros-args"),
        *("-r", "__node:=pilot", "-r", "__ns:=/r1"),
        *("--params-file", f"{folder}/shared.yaml"),
        *("--params-file", f"{folder}/own.yaml"),
        *("-p", "use_sim_time:=true", "-p", "rate_hz:=9"),
        *("-p", "gains.p:=1.5", "-p", "gains.on:=true", "-r", "scan:=/lidar"),
    )
    assert process.label == "drive/quick"
    assert process.cwd == str(folder)
    assert process.env["LEVEL"] == "3"
    assert process.env["QUIET"] == "true"
    assert process.env["HERE"] == str(folder)
    assert process.restart == RestartPolicy(
        condition="always", max_attempts=2, delay_s=0.1
    )
    assert process.stop_timeout_s == 2.0
    assert process.reports_ready
    files = ["node.py", "shared.yaml", "own.yaml", "extra"]
    assert set(service.watched) == {str(folder / name) for name in files}
    assert ServiceConfig.from_json(service.to_json()) == service


def test_default_names(bench: Any) -> None:
    bench.write("", "node.py")
    bench.write("", "it.launch.py")
    bench.write(
        """
        services:
          m:
            nodes:
              - node.py
              - node.py:Drive
              - a.b:Talker -x
              - navette planner --robot husky
              - planner
              - launch: it.launch.py speed:=1
                processes: true
              - command: [echo, hello there]
              - command: echo a && echo b
                shell: true
          node:
            nodes: [node.py]
        """
    )
    first, second = bench.specs()
    assert [process.name for process in first.processes] == [
        *("node", "Drive", "Talker", "planner", "planner-2", "it", "echo", "echo-2")
    ]
    assert second.processes[0].label == "node"
    launch, echo, shell = first.processes[5:]
    assert launch.argv[3:] == (
        *("navette", "launch", "--processes", "it.launch.py", "speed:=1"),
    )
    assert echo.argv == ("echo", "hello there")
    assert not echo.reports_ready
    assert shell.shell


def test_dependencies_come_first(bench: Any) -> None:
    bench.write("", "n.py")
    bench.write(
        """
        services:
          viewer: {depends_on: [robot], nodes: [n.py]}
          robot: {depends_on: [sim], nodes: [n.py]}
          sim: {nodes: [n.py]}
          other: {nodes: [n.py]}
        """
    )
    assert [spec.name for spec in bench.specs("viewer")] == ["sim", "robot", "viewer"]


def node(extra: str) -> str:
    return f"services: {{m: {{nodes: [{{run: n.py, {extra}}}]}}}}"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("services: [", "navette.yaml:2: not YAML"),
        ("[]", "expected 'services:'"),
        ("services: {}", "expected 'services:'"),
        ("servics: {}", "unknown key 'servics'; did you mean 'services'"),
        ("services: {m: [a]}", "service 'm': expected a mapping"),
        ("services: {a b: {}}", "service name 'a b'"),
        ("services: {m: {}}", "service 'm': expected 'nodes'"),
        ("services: {m: {node: []}}", "unknown key 'node'; did you mean 'nodes'"),
        ("services: {m: {nodes: n.py}}", "nodes: 'n.py': expected a list"),
        (
            "services: {m: {nodes: [{name: x}]}}",
            "exactly one of run, launch, command; found none",
        ),
        ("services: {m: {nodes: [3]}}", "3: expected the arguments of"),
        ("services: {m: {nodes: [no.py]}}", "no.py: no such file"),
        ("services: {m: {nodes: [navette planer]}}", "unknown executable .*'planer'"),
        ("services: {m: {nodes: [unknown talker]}}", "package 'unknown' not found"),
        ("services: {m: {nodes: [{launch: no.launch.py}]}}", "no such launch file"),
        ("services: {m: {nodes: [{command: no-such}]}}", "'no-such': no such program"),
        (
            "services: {m: {nodes: [{command: ls, remap: {}}]}}",
            "remap is valid with 'run' only",
        ),
        (
            "services: {m: {depends_on: [x], nodes: [n.py]}}",
            "depends on unknown service 'x' \\(services: m",
        ),
        (
            "services: {a: {depends_on: [b], nodes: [n.py]}, "
            "b: {depends_on: [a], nodes: [n.py]}}",
            "dependency cycle: a → b → a",
        ),
        ("a: &a [1]\nservices: *a", "YAML alias"),
        (node("speed: 3"), "unknown key 'speed'"),
        (
            node("restart: sometimes"),
            "'sometimes': expected one of no, on-failure",
        ),
        (node("restart: {attempts: 3}"), "unknown key 'attempts'"),
        (node("restart: {max_attempts: -3}"), "max_attempts: -3: expected 0 or more"),
        (node("stop_timeout_s: soon"), "'soon': expected seconds"),
        (node("parameters: [1]"), "expected a mapping"),
        (node("parameter_files: [p.yaml]"), "p.yaml"),
        (node("remap: {'a b': c}"), "a b"),
        (node("environment: [1]"), "expected a mapping"),
        (
            node("parameters: {a: $(var x)}"),
            "unknown argument 'x' .*: none",
        ),
        (node("arguments: hm"), "'hm': expected a list"),
        ("services: {m: {nodes: ['n.py \"a']}}", "No closing quotation"),
    ],
)
def test_an_invalid_file_is_an_error(bench: Any, text: str, reason: str) -> None:
    bench.write("", "n.py")
    bench.write(text)
    with pytest.raises(NavetteError, match=reason):
        bench.specs()


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("    nods: [n.py]", ":5: service 'm': unknown key 'nods'"),
        ("    restart: sometimes", ":5: .*'sometimes': expected"),
        ("    environment: {A: $(var x)}", ":5: .*unknown argument 'x'"),
        ("    depends_on: [x]", ":5: .*unknown service 'x'"),
        ("    nodes: [n.py]", ":5: duplicate key 'nodes', first in line 3"),
        ("      - nn.py", ":5: .*nn.py: no such file; did you mean n.py"),
        ("      - p/n.py", ":5: .*p/n.py: no such file; there is n.py"),
        ("      - run: n.py\n        remap: {'a b': c}", ":6: .*topic name"),
        ("      - run: n.py\n        speed: 3", ":6: .*unknown key 'speed'"),
        ("servic: {}", ":5: unknown key 'servic'"),
        ("environment: 3", ":5: .*environment: 3: expected a mapping"),
    ],
)
def test_an_error_names_the_line(bench: Any, line: str, reason: str) -> None:
    bench.write("", "n.py")
    bench.write(f"services:\n  m:\n    nodes:\n      - n.py\n{line}\n")
    with pytest.raises(FileFormatError, match=f"navette.yaml{reason}"):
        bench.specs()


def test_environment_of_all_services(bench: Any) -> None:
    bench.write("", "n.py")
    bench.write(
        """
        environment: {ROS_DOMAIN_ID: 7, LEVEL: 1}
        services:
          m: {nodes: [n.py], environment: {LEVEL: 2}}
        """
    )
    (service,) = bench.specs()
    env = service.processes[0].env
    assert (env["ROS_DOMAIN_ID"], env["LEVEL"]) == ("7", "2")


def test_unknown_services_and_arguments(bench: Any) -> None:
    bench.write("", "n.py")
    bench.write("arguments: {world: a}\nservices: {robot: {nodes: [n.py]}}")
    with pytest.raises(InvalidValueError, match="did you mean 'robot'"):
        bench.specs("robt")
    with pytest.raises(InvalidValueError, match="no argument 'wrld'; did you mean"):
        bench.read(wrld="b")


def test_the_project_is_found_from_a_subfolder(bench: Any) -> None:
    file = bench.write("services: {}")
    below = bench.folder / "a" / "b"
    below.mkdir(parents=True)
    assert find_project(below) == Project(bench.folder, file)
    other = below / "other.yaml"
    other.touch()
    assert find_project(below, other).folder == below
    with pytest.raises(NavetteError, match="no such file"):
        find_project(below, below / "missing.yaml")


def test_the_built_in_services(tmp_path: Path) -> None:
    content = read_config(Project(tmp_path), {"robot": "husky"})
    assert content.path == DEFAULT_FILE
    specs = {spec.name: spec for spec in content.specs(content.names)}
    assert set(specs) == {"sim", "robot", "viewer"}
    names = [process.name for process in specs["robot"].processes]
    assert names == [
        "localization",
        "costmap",
        "tracking",
        "map_memory",
        "zones",
        "planner",
        "control",
        "behaviors",
        "reflex",
        "arbiter",
        "missions",
        "lifecycle_manager",
    ]
    for process in specs["robot"].processes:
        assert "use_sim_time:=true" in process.argv
        if process.name != "lifecycle_manager":
            assert process.argv[process.argv.index("--robot") + 1] == "husky"


def test_the_switch_of_localization_reaches_simulator_and_localization(
    tmp_path: Path,
) -> None:
    given = {"localization": "odometry+imu+gnss", "map": "hall.yaml"}
    content = read_config(Project(tmp_path), given)
    lines = {
        process.name: " ".join(process.argv)
        for spec in content.specs(content.names)
        for process in spec.processes
    }
    assert "-p localization:=odometry+imu+gnss" in lines["sim"]
    assert lines["localization"].count("--localization odometry+imu+gnss") == 1
    assert "-p map_file:=hall.yaml" in lines["map_memory"]
