"""The house rules that a machine can check (docs/design.md, "The house")."""

import ast
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import navette
from navette.navigation.stack.stack import FLOW as WIRED

ROOT = Path(__file__).parent.parent
SOURCE = ROOT / "src" / "navette"
SLEEPS = ("time.sleep", "asyncio.sleep")
LINT = "from importlinter.cli import lint_imports_command as lint; lint()"
FLOW = (
    "sim",
    "localization",
    "slam",
    "costmap",
    "tracking",
    "mapping",
    "planning",
    "control",
    "behaviors",
    "arbiter",
    "missions",
)
# Classes with the constructors of rclpy, and the folder of ROS 2's other packages.
RCLPY = {
    "ActionServer",
    "EventHandler",
    "GuardCondition",
    "JumpHandle",
    "NumberOfEntities",
    "ParameterCallbackHandle",
    "ParameterEventCallbackHandle",
    "PollSet",
    "QoSProfile",
    "Service",
    "Subscription",
    "Task",
    "Timer",
}
ROS2_PACKAGES = SOURCE / "ros2" / "packages"
MOST_POSITIONAL = 5
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def python_files(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.py"))


def test_import_contracts_hold() -> None:
    """Layers, forbidden imports and cycles, as pyproject.toml states them."""
    done = subprocess.run(
        [sys.executable, "-c", LINT],
        cwd=ROOT,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_stages_have_one_order_everywhere() -> None:
    """The README's picture, the layers contract and the stack agree."""
    contracts = PYPROJECT["tool"]["importlinter"]["contracts"]
    layers = next(c for c in contracts if c.get("containers") == ["navette.navigation"])
    [stages] = [each.split(" | ") for each in layers["layers"] if "planning" in each]
    assert tuple(reversed(stages)) == FLOW[1:]

    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    picture = readme[readme.index("<!-- flow -->") : readme.index("<!-- /flow -->")]
    words = re.findall(r"\b(" + "|".join(FLOW) + r")\b", picture)
    assert tuple(dict.fromkeys(words)) == FLOW

    assert WIRED == FLOW


def test_every_folder_is_a_package_that_imports_no_node() -> None:
    shared = SOURCE / "msgs" / "definitions"  # what the interface packages contain
    code = (path for path in python_files(SOURCE) if shared not in path.parents)
    for folder in {path.parent for path in code}:
        init = folder / "__init__.py"
        assert init.is_file(), f"{folder} has no __init__.py"
        for module in imported_modules(init):
            stage_node = re.fullmatch(r"navette\.(?!runtime|ros2)[\w.]+\.node", module)
            assert not stage_node, f"{init} imports {module}"


def imported_modules(path: Path) -> list[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found: list[str] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.append(node.module)
    return found


def own_classes() -> Iterator[tuple[str, ast.ClassDef]]:
    """Yield the classes whose constructors ROS 2 does not define, with their place."""
    for path in python_files(SOURCE):
        if ROS2_PACKAGES in path.parents:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef) and node.name not in RCLPY:
                yield f"{path.relative_to(SOURCE)}: {node.name}", node


def constructor(cls: ast.ClassDef) -> ast.arguments | None:
    for node in cls.body:
        if isinstance(node, ast.FunctionDef) and node.name == "__init__":
            return node.args
    return None


def is_record(cls: ast.ClassDef) -> bool:
    marks = [*cls.decorator_list, *cls.bases]
    return any(re.search(r"\b(dataclass|NamedTuple)\b", ast.unparse(m)) for m in marks)


def parameter_types(cls: ast.ClassDef) -> Iterator[tuple[str, str]]:
    """Yield the parameters of a constructor, or the fields of a record."""
    given = constructor(cls)
    if given is not None:
        for each in (*given.posonlyargs, *given.args, *given.kwonlyargs):
            if each.annotation is not None:
                yield each.arg, ast.unparse(each.annotation)
    elif is_record(cls):
        for node in cls.body:
            if isinstance(node, ast.AnnAssign):
                yield ast.unparse(node.target), ast.unparse(node.annotation)


def test_constructors_receive_named_interfaces() -> None:
    """A function that a class calls has a protocol or a type with a name.

    Several functions of one owner are a protocol that the owner implements; a single
    event is a named type such as ``OnDamage``.
    """
    unnamed = [
        f"{place}({name}: {kind})"
        for place, cls in own_classes()
        for name, kind in parameter_types(cls)
        if "Callable[" in kind
    ]
    assert not unnamed


def test_constructors_have_few_positional_parameters() -> None:
    found = {}
    for place, cls in own_classes():
        given = constructor(cls)
        if given is not None:
            count = len(given.posonlyargs) + len(given.args) - 1  # without self
            if count > MOST_POSITIONAL:
                found[place] = count
    assert not found


def test_tests_do_not_sleep() -> None:
    """Except programs under test whose sleeping is the point: they say so."""
    for path in python_files(ROOT / "tests"):
        text = path.read_text(encoding="utf-8")
        lines = text.splitlines()
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in SLEEPS:
                line = lines[node.lineno - 1]
                assert "# as ROS 2 programs do" in line, f"{path}:{node.lineno}"


def test_no_folder_is_named_after_nothing() -> None:
    nothing = {"utils", "util", "helpers", "common", "misc"}
    names = {path.stem for path in SOURCE.rglob("*")}
    assert not names & nothing


def test_the_package_needs_nothing_outside_itself() -> None:
    """No path of a machine or of a neighbouring folder in code or data."""
    text_files = {".py", ".pyi", ".yaml", ".sdf", ".json", ".html", ".toml", ".md"}
    for path in SOURCE.rglob("*"):
        if path.suffix in text_files:
            text = path.read_text(encoding="utf-8")
            assert "../shared" not in text, path
            assert not re.search(r"/(home|root|work|tmp)/\w", text), path


def test_public_names_are_the_listed_ones() -> None:
    """A name that appears or vanishes is a decision: change the list with it."""
    listed = (ROOT / "tests" / "public_names.txt").read_text("utf-8").split()
    assert sorted(navette.__all__) == listed


def test_importing_navette_loads_nothing_heavy() -> None:
    code = "import sys, navette; print(*sorted(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    loaded = set(done.stdout.split())
    assert not loaded & {"numpy", "numba", "mujoco", "websockets", "mcap", "rich"}
