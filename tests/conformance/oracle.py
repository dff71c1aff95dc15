"""Compare programs that visit rclpy's corners with what a real rclpy printed.

    python tests/conformance/oracle.py FOLDER [--write] [--show]

FOLDER holds ``programs/`` and ``rclpy_7.1.3/``, which has a file of lines
``label: result`` for each program. A line's state is one of

- ``same``: Navette prints the same (addresses aside);
- ``text``: both raise, and ``except`` of rclpy's class catches Navette's error;
- ``class``: both raise, and it does not;
- ``differs``: any other result.

``oracle_results.toml`` states the lines that are not the same, and
``oracle_reasons.toml`` has a reason for each that differs or raises another class.
Exits with 1 where a line has another state or no reason. None of the programs is part
of this repository.
"""

# ruff: noqa: T201 - it prints a report

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

STATED = Path(__file__).with_name("oracle_results.toml")
REASONS = Path(__file__).with_name("oracle_reasons.toml")
PROGRAMS = (
    "s01_messages s02_time s03_names s04_params s05_args s06_qos s07_executor "
    "s08_timer s09_action s10_lifecycle s11_logging s12_serial s13_paramclient "
    "s14_services s17_alias s18_threads s19_misc"
).split()
TIMEOUT_S = 120
STATES = ("same", "text", "class", "differs")
#: Results that another run may print otherwise.
_ADDRESS = re.compile(r"0x[0-9a-f]+")
Reasons = list[tuple[str, str, dict[str, Any]]]


def run_program(program: Path) -> dict[str, str]:
    """Return the results that a program prints on Navette, by label."""
    with tempfile.TemporaryDirectory(prefix="navette_oracle_") as scratch:
        try:
            done = subprocess.run(
                [sys.executable, "-m", "navette", "run", str(program)],
                cwd=scratch,
                env=os.environ
                | {"NAVETTE_TRANSPORT": "inprocess", "NAVETTE_RUNTIME_DIR": scratch},
                capture_output=True,
                text=True,
                timeout=TIMEOUT_S,
                check=False,
            )
            return read_results(done.stdout)
        except subprocess.TimeoutExpired as late:
            return read_results((late.stdout or b"").decode(errors="replace"))


def read_results(text: str) -> dict[str, str]:
    """Return the lines ``label: result``; repeated labels are counted.

    Lines without a label are ``line``, ``line_2`` and so on.
    """
    found: dict[str, str] = {}
    for line in filter(None, text.splitlines()):
        label, result = _split(line)
        name, count = label, 1
        while name in found:
            count += 1
            name = f"{label}_{count}"
        found[name] = result
    return found


def _split(line: str) -> tuple[str, str]:
    """Split at the first ``: `` that is not inside quotes."""
    at = line.find(": ")
    while at >= 0 and line.count("'", 0, at) % 2:
        at = line.find(": ", at + 1)
    return ("line", line) if at < 0 else (line[:at], line[at + 2 :])


def state(real: str, ours: str | None) -> str:
    """Return how a result compares with the real one."""
    if ours is None:
        return "differs"
    if _ADDRESS.sub("0x", ours) == _ADDRESS.sub("0x", real):
        return "same"
    if not (real.startswith("!") and ours.startswith("!")):
        return "differs"
    caught, raised = (text[1:].partition(":")[0].split("/") for text in (real, ours))
    return "text" if caught[0] in raised else "class"


def read_reasons() -> Reasons:
    """Return program, pattern of labels and group, in order."""
    groups = tomllib.loads(REASONS.read_text(encoding="utf-8"))["reason"]
    return [
        (program, pattern, group)
        for group in groups
        for program, patterns in group["lines"].items()
        for pattern in patterns
    ]


def reason_of(name: str, label: str, reasons: Reasons) -> dict[str, Any] | None:
    """Return the group of a line, None without any."""
    for program, pattern, group in reasons:
        if name.startswith(program) and fnmatchcase(label, pattern):
            return group
    return None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--write", action="store_true", help="state today's results")
    parser.add_argument("--show", action="store_true", help="print what differs")
    options = parser.parse_args()
    reasons = read_reasons()
    found: dict[str, dict[str, str]] = {}
    problems: list[str] = []
    for name in PROGRAMS:
        real = read_results((options.folder / f"rclpy_7.1.3/{name}.txt").read_text())
        ours = run_program((options.folder / f"programs/{name}.py").resolve())
        found[name] = {label: state(real[label], ours.get(label)) for label in real}
        counts = Counter(found[name].values())
        print(name, *(f"{word} {counts[word]}" for word in STATES))
        for label, word in found[name].items():
            has_reason = reason_of(name, label, reasons) is not None
            if word in ("class", "differs") and not has_reason:
                problems.append(f"{name}: {label}: {word} without a reason")
            if options.show and word in ("class", "differs"):
                print(f"  {label}\n    {real[label]}\n    {ours.get(label)}")
    total = Counter(word for words in found.values() for word in words.values())
    print("all:", *(f"{word} {total[word]}" for word in STATES))
    if options.write:
        STATED.write_text(_as_toml(found), encoding="utf-8")
    else:
        stated = tomllib.loads(STATED.read_text("utf-8"))
        problems += _changes(found, stated, reasons)
    print(*problems, sep="\n")
    return 1 if problems else 0


def _as_toml(found: dict[str, dict[str, str]]) -> str:
    lines = []
    for name, words in found.items():
        lines.append(f"[{name}]")
        for wanted in STATES[1:]:
            labels = [label for label, word in words.items() if word == wanted]
            items = "".join(f"  {json.dumps(label)},\n" for label in labels)
            lines.append(f"{wanted} = [\n{items}]")
    return "\n".join(lines) + "\n"


def _changes(
    found: dict[str, dict[str, str]],
    stated: dict[str, dict[str, list[str]]],
    reasons: Reasons,
) -> list[str]:
    """Return the lines whose state is another one than stated."""
    changed = []
    for name, words in found.items():
        groups = stated.get(name, {}).items()
        before = {label: word for word, labels in groups for label in labels}
        for label, word in words.items():
            expected = before.get(label, "same")
            varies = (reason_of(name, label, reasons) or {}).get("varies", False)
            if word != expected and not varies:
                changed.append(f"{name}: {label}: {word}, stated {expected}")
    return changed


if __name__ == "__main__":
    sys.exit(main())
