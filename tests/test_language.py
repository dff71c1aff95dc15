"""Plain technical English, unique class names, and units in parameter names.

To fix a failure, use the field's standard term, name the subject and say what it does.
A true use of a banned phrase goes into ``ALLOWED``, with the words around it.
"""

import ast
import dataclasses
import re
import typing
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from navette.bags.params import RecorderParams
from navette.navigation.gym.params import NavigationEnvParams
from navette.navigation.stack.stage_classes import node_classes
from navette.params import Params, info_of, unit_of
from navette.viewer.params import ViewerParams

ROOT = Path(__file__).parent.parent
SOURCE = ROOT / "src" / "navette"

#: Regular expression (whole words, any case) → what to write instead.
BANNED = {
    r"nobody": "name the subject: no node, no subscriber, no process",
    r"anew": "again, or restart",
    r"those (that|who|whom|which)": "name the noun",
    r"strangers?": "other process, other domain, unknown peer",
    r"whoever|whom": "name the role",
    r"hears?|heard|hearing": "receives, received",
    r"tells|told": "reports, publishes, states",
    r"says|said": "reports, publishes, states",
    r"knows": "stores, has, depends on",
    r"wants": "requires, requests",
    r"asks": "requests, requires, queries",
    r"complains?|complained": "warns, logs",
    r"dies|died": "exits, crashes, fails",
    r"(falls?|fell|goes|went) silent": "stops publishing, stops responding",
    r"stands still": "is stationary, stops",
    r"go(es)? on": "continues",
    r"no way": "no path, cannot",
    r"as the crow flies": "in a straight line",
    r"to and fro|by fits and starts": "back and forth, intermittently",
    r"letters?": "message, or the character class in ALLOWED",
    r"farewells?|goodbye|forsake|errands?|mailbox|witness(es)?|kin": "see the glossary",
    r"(?<!there )(is|are|was|were) no (?!(longer|more|less|other|such|\w+er)\b)\w+": (
        "is not a …, or has no …"
    ),
}

#: True uses: a banned phrase within one of these is no fault.
ALLOWED = (
    r"letters,? (and )?digits",
    r"(capital|lower-?case|upper-?case|small|drive|ascii) letters?",
    r"letters, (numbers|underscores)",
    r"process has died",  # the message of ROS 2's launch
    r"letter-spacing",  # CSS
    r"I heard|Listener heard|Talker says|heard enough",  # ROS 2's demos
    r"do not say, hear, know or want",
)

#: Identifiers that contain a banned word and are right.
ALLOWED_NAMES = (r"wants_\w+",)

#: Class names that ROS 2's API needs twice, with the reason.
SHARED_NAMES: dict[str, str] = {
    "Shutdown": "launch has an action and an event of this name",
    "IncludeLaunchDescription": "launch has an action and an event of this name",
    "EventHandler": "launch's handler of events, and rclpy's of QoS events",
    "LifecycleNode": "launch_ros's action, and rclpy's node",
    "Node": "launch_ros's action, and rclpy's node",
    "Parameter": "launch_ros's description and substitution, and rclpy's value",
    "TimeoutException": "rclpy's and tf2's",
}

#: Parameters without a unit although they are real numbers.
DIMENSIONLESS = (
    r".*_rejection_threshold",  # Mahalanobis distances
    r"(process_noise|initial_estimate)_covariance|initial_state",  # mixed units
    r"\w+_probability|belief_limit|occupied_threshold|lidar_dropout",
    r"mppi_(\w+_weight|temperature|samples|steps)",
    r"(progress|goal)_reward|(time|contact)_penalty",
    r"(clearance|map_cost)_weight|unknown_cost|(reverse|evasion)_factor|stale_periods",
    r"(switch|frontier)_gain|wheel_scale_error",
    r"odometry_noise|(loop_)?min_(overlap|score)|max_contradicted",  # shares
    # Names of Nav2's AMCL, in metres, radians and seconds; and shares.
    r"transform_tolerance|alpha[1-5]|update_min_[da]|laser_\w+|sigma_hit|z_\w+",
    r"lambda_short|beam_skip_\w+|save_pose_rate",
    r"speed_base|speed_multiplier|independent_beams|pf_\w+|recovery_alpha_\w+|(lost|localized)_match",
    # Names of twist_mux, in seconds.
    r"timeout|hold",
    # Names of Nav2's layers, in metres and seconds; and a probability.
    r"origin_z|z_resolution|(min|max)_obstacle_height|max_drop_height|phi",
    r"(obstacle|raytrace)_(min|max)_range|mark_threshold",
    r"expected_update_rate|no_readings_timeout",
)


def texts() -> Iterator[tuple[Path, str]]:
    """Path relative to the repository and text of every file that people read."""
    patterns = ("src/navette/**/*.py", "tests/**/*.py", "docs/**/*.py", "docs/**/*.md")
    more = ("examples/**/*.py", "benchmarks/**/*.py", "*.md", "src/navette/**/*.html")
    for pattern in (*patterns, *more):
        for path in sorted(ROOT.glob(pattern)):
            relative = path.relative_to(ROOT)
            generated = relative.parts[:2] in (("docs", "api"), ("docs", "site"))
            if path != Path(__file__) and not generated:
                yield relative, path.read_text(encoding="utf-8")


def identifiers(text: str) -> Iterator[str]:
    """Names of functions, classes and arguments, and assigned names."""
    for node in ast.walk(ast.parse(text)):
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                yield node.name
            case ast.Name(id=name, ctx=ast.Store()):
                yield name
            case ast.Attribute(attr=name, ctx=ast.Store()):
                yield name
            case ast.arg(arg=name):
                yield name


ANY_BANNED = re.compile(rf"\b(?:{'|'.join(BANNED)})\b")
EACH_BANNED = [(re.compile(phrase), advice) for phrase, advice in BANNED.items()]
ANY_ALLOWED = re.compile("|".join(ALLOWED), re.IGNORECASE)


def faults(relative: Path, text: str) -> Iterator[str]:
    """``file:line: phrase → what to write instead``."""
    allowed = [(span.start(), span.end()) for span in ANY_ALLOWED.finditer(text)]
    text = text.lower()  # ten times as fast as re.IGNORECASE
    for found in ANY_BANNED.finditer(text):
        start, end = found.span()
        if any(first <= start and end <= last for first, last in allowed):
            continue
        line = text.count("\n", 0, start) + 1
        advice = next(a for each, a in EACH_BANNED if each.match(text, start, end))
        yield f"{relative}:{line}: {found[0]!r}; instead: {advice}"


def test_the_text_is_free_of_banned_phrases() -> None:
    found = [fault for relative, text in texts() for fault in faults(relative, text)]
    assert not found, "\n".join(found)


def test_identifiers_are_free_of_banned_phrases() -> None:
    found = []
    for relative, text in texts():
        if relative.suffix != ".py":
            continue
        names = [
            name
            for name in identifiers(text)
            if not any(re.fullmatch(each, name) for each in ALLOWED_NAMES)
        ]
        found += faults(relative, "\n".join(names).replace("_", " "))
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "text",
    ["nobody listens", "The node\nsays so", "a car is no boat", "it starts anew"],
)
def test_a_banned_phrase_is_found(text: str) -> None:
    assert list(faults(Path("any.md"), text))


@pytest.mark.parametrize(
    "text", ["letters and digits", "There is no path", "is no longer valid", "renew"]
)
def test_plain_english_is_accepted(text: str) -> None:
    assert not list(faults(Path("any.md"), text))


def public_classes() -> dict[str, list[str]]:
    """Name of each public class of a module's top level → files that define it."""
    found: dict[str, list[str]] = defaultdict(list)
    for path in sorted(SOURCE.rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                found[node.name].append(path.relative_to(SOURCE).as_posix())
    return found


def test_a_public_class_name_occurs_once() -> None:
    several = {name: at for name, at in public_classes().items() if len(at) > 1}
    known = SHARED_NAMES.keys()
    found = {name: at for name, at in several.items() if name not in known}
    assert not found, found
    settled = known - several.keys()
    assert not settled, f"occur once now: take {sorted(settled)} out of the lists"


RECORDS: tuple[type[Params], ...] = (
    *(node_class.PARAMS for _, node_class in node_classes()),
    *(each for _, kind in node_classes() for each in kind.PARAM_GROUPS.values()),
    RecorderParams,
    ViewerParams,
    NavigationEnvParams,
)


def test_every_parameter_record_is_checked() -> None:
    declared = {each.__module__.replace(".", "/") + ".py" for each in RECORDS}
    found = {
        path.relative_to(SOURCE.parent).as_posix()
        for path in SOURCE.rglob("params.py")
        if "param(" in path.read_text(encoding="utf-8")
    }
    assert found <= declared


@pytest.mark.parametrize("record", RECORDS, ids=lambda each: each.__name__)
def test_a_parameter_carries_its_unit_in_its_name(record: type[Params]) -> None:
    hints = typing.get_type_hints(record)
    for field in dataclasses.fields(record):
        unit, name = unit_of(field.name), field.name
        where = f"{record.__name__}.{name}"
        assert info_of(field).unit == unit, f"{where}: its unit is not in its name"
        if not unit and hints[name] in (float, tuple[float, ...]):
            known = any(re.fullmatch(each, name) for each in DIMENSIONLESS)
            assert known, f"{where}: end its name in its unit, or add to DIMENSIONLESS"
        if unit:
            assert hints[name] not in (str, bool), f"{where}: ends in a unit"
