"""Copy buttons of a report of `navette bench`: in the panel and in its own page."""

import shutil
import sys
from pathlib import Path

import pytest
from test_viewer_javascript import run_node

from navette.navigation.bench.replay_command import replay_command
from navette.navigation.bench.report import ReportedRun, report_page
from navette.navigation.bench.trial import Trial, TrialResult

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Program

pytestmark = pytest.mark.long


def result(trial: Trial, score: float) -> TrialResult:
    return TrialResult(
        suite=trial.suite,
        name=trial.name,
        seed=trial.seed,
        outcome="reached",
        time_s=10.0,
        score=score,
        contacts=0,
        path_m=11.0,
        shortest_m=10.0,
        min_clearance_m=0.2,
        lost_s={"following": 1.0},
        jerk=2.0,
        wall_s=0.5,
        track=[[0.0, 0.0], [1.0, 2.0]],
    )


@pytest.mark.slow
def test_commands_are_copied_from_a_report(tmp_path: Path) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    trials = [
        Trial(
            suite="rooms", name=f"rooms-{seed}", world=f"rooms:{seed}", goals=((1, 2),)
        )
        for seed in (7, 8)
    ]
    results = [
        result(trial, score) for trial, score in zip(trials, (0.1, 0.4), strict=True)
    ]
    page = report_page("rooms", [ReportedRun.of("", results, trials)], [])
    path = tmp_path / "report.html"
    path.write_text(page)
    with Program() as program:
        seen = run_node("report.mjs", program.viewer.url, chromium, str(path))
    worst, best = map(replay_command, trials)
    assert seen["problems"] == []
    assert seen["count"] == 2
    assert (seen["panel"], seen["file"]) == (best, worst)
    assert seen["refused"]["selected"] == worst
    assert "selected" in seen["refused"]["answer"]
