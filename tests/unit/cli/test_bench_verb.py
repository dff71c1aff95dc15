"""``navette bench``: comparison of results in files, exit codes."""

import dataclasses
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from navette.cli.app import app
from navette.errors import InvalidValueError, UnknownNameError
from navette.navigation.bench.trial import TrialResult

GOOD = TrialResult(
    suite="maze", name="maze-0", seed=0, outcome="reached", time_s=10.0, score=0.5,
    contacts=0, path_m=10.0, shortest_m=10.0, min_clearance_m=0.2, lost_s={}, jerk=1.0,
    wall_s=1.0, sim_s=10.0,
)  # fmt: skip


def written(path: Path, results: list[TrialResult]) -> str:
    rows = [{"key": str(i), **dataclasses.asdict(r)} for i, r in enumerate(results)]
    text = "".join(json.dumps(row) + "\n" for row in rows)
    path.write_text(text, encoding="utf-8")
    return str(path)


def compared(*words: str) -> tuple[int, str]:
    options = [word for each in words for word in ("--compare", each)]
    ended = CliRunner().invoke(app, ["bench", "maze", "--worlds", "0", *options])
    if ended.exception is not None and not isinstance(ended.exception, SystemExit):
        raise ended.exception
    return ended.exit_code, ended.stdout


def test_files_of_results_are_compared_without_a_drive(tmp_path: Path) -> None:
    good = [dataclasses.replace(GOOD, seed=seed) for seed in range(12)]
    bad = [
        dataclasses.replace(r, outcome="stuck", score=0.0) if r.seed > 3 else r
        for r in good
    ]
    a, b = written(tmp_path / "a.jsonl", good), written(tmp_path / "b.jsonl", bad)
    code, text = compared(a, b)
    assert code == 1
    assert "success -0.6667" in text
    assert "12 pairs, worse" in text
    assert compared(b, a)[0] == 0
    assert compared(a, a)[0] == 0
    report = tmp_path / "report.html"
    ended = CliRunner().invoke(
        app,
        [*("bench", "maze", "--compare", a, "--compare", b), "--report", str(report),
         "--json"],
    )  # fmt: skip
    values = json.loads(ended.stdout)
    assert values["success"] == pytest.approx(1 / 3)
    assert values["baseline"]["success"] == 1.0
    assert "stuck" in report.read_text(encoding="utf-8")


def test_files_without_a_common_trial_are_an_error(tmp_path: Path) -> None:
    a = written(tmp_path / "a.jsonl", [GOOD])
    b = written(tmp_path / "b.jsonl", [dataclasses.replace(GOOD, seed=7)])
    with pytest.raises(InvalidValueError, match="no trial in common"):
        compared(a, b)
    with pytest.raises(InvalidValueError, match="expected BASELINE, or BASELINE MINE"):
        compared(a, b, a)


def refused(*words: str) -> str:
    ended = CliRunner().invoke(app, ["bench", "maze", *words])
    assert isinstance(ended.exception, InvalidValueError)
    return str(ended.exception)


@pytest.mark.parametrize("text", ["3-1", "x", "1-", "-2", "1,,x", "٣-x"])
def test_worlds_are_numbers_and_ranges(text: str) -> None:
    assert f"--worlds {text!r}" in refused(f"--worlds={text}")


def test_places_of_output_are_checked_before_driving(tmp_path: Path) -> None:
    for option in ("--results", "--report"):
        missing = str(tmp_path / "missing" / "file")
        assert "does not exist" in refused(option, missing)
        assert "is a folder; name a file" in refused(option, str(tmp_path))


def test_a_node_that_cannot_be_replaced_is_refused_before_its_file_is_read() -> None:
    words = ["bench", "maze", "--worlds", "0", "--replace", "wheels=nowhere.py"]
    ended = CliRunner().invoke(app, words)
    with pytest.raises(UnknownNameError, match="unknown node to replace 'wheels'"):
        raise ended.exception or AssertionError("no error")
