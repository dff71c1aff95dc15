"""Compare programs that visit rclpy's corners with what a real rclpy printed.

    python tests/conformance/oracle.py FOLDER [--write]

FOLDER holds ``programs/`` and ``rclpy_7.1.3/``, which has a file of lines
``label: result`` for each program. ``oracle_results.toml`` states for each line
whether Navette prints the same (``same``), raises as rclpy does with another class or
text (``error``), or answers in another way (``differs``). Exits with 1 where a line has
another state. None of the programs is part of this repository.
"""

# ruff: noqa: T201 - it prints a report

import argparse
import os
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from pathlib import Path

STATED = Path(__file__).with_name("oracle_results.toml")
PROGRAMS = (
    "s01_messages s02_time s03_names s04_params s05_args s06_qos s07_executor "
    "s08_timer s09_action s10_lifecycle s11_logging s12_serial s13_paramclient "
    "s14_services s17_alias s18_threads s19_misc"
).split()
TIMEOUT_S = 120
STATES = ("same", "error", "differs")


def run_program(program: Path) -> dict[str, str]:
    """Return the results that a program prints on Navette, by label."""
    with tempfile.TemporaryDirectory(prefix="navette_oracle_") as scratch:
        try:
            done = subprocess.run(
                [sys.executable, "-m", "navette", "run", str(program)],
                cwd=scratch,
                env=os.environ | {"NAVETTE_TRANSPORT": "inprocess"},
                capture_output=True,
                text=True,
                timeout=TIMEOUT_S,
                check=False,
            )
            return read_results(done.stdout)
        except subprocess.TimeoutExpired as late:
            return read_results((late.stdout or b"").decode(errors="replace"))


def read_results(text: str) -> dict[str, str]:
    """Return the lines ``label: result``; repeated labels are counted."""
    found: dict[str, str] = {}
    for line in text.splitlines():
        label, colon, result = line.partition(": ")
        if not colon or not label.replace("_", "a").isalnum():
            continue
        name, count = label, 1
        while name in found:
            count += 1
            name = f"{label}_{count}"
        found[name] = result
    return found


def state(real: str, ours: str | None) -> str:
    """Return how a result compares with the real one."""
    if ours == real:
        return "same"
    raised = real.startswith("!") and ours is not None and ours.startswith("!")
    return "error" if raised else "differs"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--write", action="store_true", help="state today's results")
    options = parser.parse_args()
    found: dict[str, dict[str, str]] = {}
    for name in PROGRAMS:
        real = read_results((options.folder / f"rclpy_7.1.3/{name}.txt").read_text())
        ours = run_program((options.folder / f"programs/{name}.py").resolve())
        found[name] = {label: state(real[label], ours.get(label)) for label in real}
        counts = Counter(found[name].values())
        print(
            name, *(f"{word} {counts[word]}" for word in ("same", "error", "differs"))
        )
    total = Counter(word for words in found.values() for word in words.values())
    print("all:", *(f"{word} {total[word]}" for word in STATES))
    if options.write:
        sections = [
            "\n".join(
                [f"[{name}]", *(f'{key} = "{word}"' for key, word in words.items())]
            )
            for name, words in found.items()
        ]
        STATED.write_text("\n\n".join(sections) + "\n", encoding="utf-8")
        return 0
    stated = tomllib.loads(STATED.read_text(encoding="utf-8"))
    changed = [
        f"{name}: {label}: {word}, stated {stated.get(name, {}).get(label)}"
        for name, words in found.items()
        for label, word in words.items()
        if word != stated.get(name, {}).get(label)
    ]
    print(*changed, sep="\n")
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
