"""Statistics, files of results, and the report."""

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import pytest

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry import Pose2
from navette.navigation.bench.losses import detour_loss, lost_seconds
from navette.navigation.bench.replay_command import replay_command
from navette.navigation.bench.report import ReportedRun, report_page
from navette.navigation.bench.run import run_trial
from navette.navigation.bench.runner import (
    finished_trials,
    read_results,
    results_of_others,
    run_trials,
    trial_key,
)
from navette.navigation.bench.statistics import compare, summarize, wilson_interval
from navette.navigation.bench.trial import Trial, TrialResult
from navette.navigation.bench.variants import with_variant


def result(name: str = "a", **values: object) -> TrialResult:
    given: dict[str, object] = {
        "suite": "rooms",
        "name": name,
        "seed": 0,
        "outcome": "reached",
        "time_s": 10.0,
        "score": 0.5,
        "contacts": 0,
        "path_m": 11.0,
        "shortest_m": 10.0,
        "min_clearance_m": 0.2,
        "lost_s": {"following": 1.0},
        "jerk": 2.0,
        "wall_s": 0.5,
        "track": [[0.0, 0.0], [1.0, 2.0]],
    }
    return TrialResult(**(given | values))  # type: ignore[arg-type]


def test_the_summary_counts_outcomes_and_averages_successes() -> None:
    summary = summarize(
        [
            result("a"),
            result("b", time_s=20.0, lost_s={"turning": 2.0}, min_clearance_m=0.1),
            result("c", outcome="contact", score=0.0, contacts=2, time_s=99.0),
        ]
    )
    assert summary.outcomes == {"contact": 1, "reached": 2}
    assert (summary.success, summary.contacts) == (2 / 3, 2)
    assert summary.time_s == 15.0
    assert summary.min_clearance_m == 0.1
    assert summary.path_ratio == pytest.approx(1.1)
    assert summary.lost_s == pytest.approx({"following": 2 / 3, "turning": 2 / 3})


def test_the_interval_of_a_share_is_wilsons() -> None:
    # Newcombe 1998, table I: 81 of 263
    low, high = wilson_interval(81, 263)
    assert (low, high) == (
        pytest.approx(0.2553, abs=1e-4),
        pytest.approx(0.3662, abs=1e-4),
    )
    assert wilson_interval(5, 5)[1] == 1.0


def test_a_clear_difference_is_significant_and_noise_is_not() -> None:
    rng = np.random.default_rng(5)
    before = [result(str(i), time_s=10.0 + rng.normal()) for i in range(30)]
    same = [dataclasses.replace(r, time_s=r.time_s + rng.normal()) for r in before]
    faster = [
        dataclasses.replace(r, time_s=r.time_s - 1 + rng.normal()) for r in before
    ]
    p_of = {c.measure: c.p_value for c in compare(before, same)}
    assert p_of["time_s"] > 0.05
    [time] = [c for c in compare(before, faster) if c.measure == "time_s"]
    assert time.difference == pytest.approx(-1, abs=0.5)
    assert time.p_value < 0.01
    assert time.low < time.difference < time.high < 0
    assert not time.is_worse
    [slower] = [c for c in compare(faster, before) if c.measure == "time_s"]
    assert slower.is_worse
    assert compare(before, [result("other")]) == []


def test_success_is_compared_over_all_trials_and_time_where_both_arrived() -> None:
    before = [result(str(i)) for i in range(20)]
    after = [
        dataclasses.replace(r, outcome="stuck", score=0.0, time_s=99.0) if i < 8 else r
        for i, r in enumerate(before)
    ]
    found = {c.measure: c for c in compare(before, after)}
    assert found["success"].difference == pytest.approx(-0.4)
    assert found["success"].is_worse
    assert found["success"].pairs == 20
    assert found["time_s"].difference == 0.0
    assert found["time_s"].pairs == 12


def test_lost_seconds_are_those_below_cruise_speed() -> None:
    time = np.arange(0, 4, 0.5)
    speed = np.array([0, 0, 1, 1, 2, 2, 2, 2.0])
    samples = np.stack([time, time, time, speed, 0 * time], axis=1)
    causes = ["blocked"] * 2 + ["following"] * 6
    assert lost_seconds(samples, causes, 2.0) == {"blocked": 1.0, "following": 0.5}


def test_finished_trials_are_read_and_damage_is_named(tmp_path: Path) -> None:
    file = tmp_path / "results.jsonl"
    trial = Trial(suite="empty", name="e", world="empty", robot="jackal",
                  goals=((2.0, 0.0),), limit_s=20.0, shortest_m=2.0)  # fmt: skip
    [first] = run_trials([trial], jobs=1, results_file=file)
    [again] = run_trials([trial], jobs=1, results_file=file)
    assert first.outcome == "reached"
    assert again == first, "read, not driven: the time on the clock is the same"
    [slower] = run_trials(
        [dataclasses.replace(trial, seed=1)], jobs=1, results_file=file
    )
    assert slower.seed == 1
    assert len(read_results(file)) == 2
    file.write_text(file.read_text(encoding="utf-8") + "{}\n", encoding="utf-8")
    with pytest.raises(FileFormatError, match=r"results\.jsonl:3"):
        read_results(file)


def test_results_of_another_version_are_compared_and_not_continued(
    tmp_path: Path,
) -> None:
    file = tmp_path / "results.jsonl"
    row = {"key": trial_key(TRIAL), **dataclasses.asdict(result("rooms-3"))}
    file.write_text(json.dumps(row | {"navette": "0.0.1"}) + "\n", encoding="utf-8")
    assert finished_trials(file, [TRIAL]) == {}
    assert results_of_others(file) == ["Navette 0.0.1"]
    assert [each.name for each in read_results(file).values()] == ["rooms-3"]
    unknown = row | {"navette": "9.0", "elegance": 1.0}
    file.write_text(json.dumps(unknown) + "\n", encoding="utf-8")
    with pytest.raises(FileFormatError, match=r"result of Navette 9\.0, which has"):
        read_results(file)


def test_the_report_escapes_names_and_refers_to_nothing_outside() -> None:
    results = [result("<b>"), result("x", outcome="stuck", score=0.0, track=[])]
    page = report_page("t & u", [ReportedRun.of("", results, [])], [])
    assert "&lt;b&gt;" in page
    assert "<b>" not in page
    assert "t &amp; u" in page
    assert "http" not in page
    assert math.isclose(page.count("<polyline"), 1)


TRIAL = Trial(
    suite="rooms", name="rooms-3", world="rooms:3", robot="jackal",
    start=Pose2(-7.5, -7.5, 0.5), goals=((7.5, 7.5),), shortest_m=20.0, reach_m=1.0,
)  # fmt: skip


def test_a_detour_is_what_was_driven_beyond_the_shortest_path() -> None:
    assert detour_loss(21.0, TRIAL, 2.0, succeeded=True) == {"detour": 1.0}
    assert detour_loss(21.0, TRIAL, 2.0, succeeded=False) == {}
    unknown = dataclasses.replace(TRIAL, shortest_m=math.nan)
    assert detour_loss(21.0, unknown, 2.0, succeeded=True) == {}


def test_variants_change_methods_and_parameters() -> None:
    own = dataclasses.replace(
        TRIAL, methods={"planner": "dijkstra"}, parameters={"control": {"a": 1}}
    )
    [mine] = with_variant([own], "mine")
    assert (mine.methods, mine.variant) == ({"planner": "dijkstra"}, "mine")
    [base] = with_variant([own], "baseline")
    assert (base.methods, base.parameters) == ({}, {})
    [other] = with_variant([own], "controller=mppi,control.b=2.5,robot=husky")
    assert other.methods == {"planner": "dijkstra", "controller": "mppi"}
    assert other.parameters == {"control": {"a": 1, "b": 2.5}}
    assert other.robot == "husky"
    for text, match in (
        ("mppi", "expected baseline"),
        ("wheels=3", "unknown setting 'wheels'; known: planner, controller"),
    ):
        with pytest.raises(InvalidValueError, match=match):
            with_variant([own], text)


def test_a_changed_method_is_driven_again(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("one", encoding="utf-8")
    own = dataclasses.replace(TRIAL, methods={"planner": f"{file}:plan"})
    assert trial_key(own) == trial_key(dataclasses.replace(own, variant="mine"))
    before = trial_key(own)
    file.write_text("another", encoding="utf-8")
    assert trial_key(own) != before


def result_line(key: str) -> str:
    return json.dumps({"key": key, **dataclasses.asdict(result())})


def test_a_result_that_was_half_written_is_not_read(tmp_path: Path) -> None:
    file = tmp_path / "results.jsonl"
    written = result_line("k") + "\n" + result_line("k")[:40]
    file.write_text(written, encoding="utf-8")
    assert list(read_results(file)) == ["k"]
    assert file.read_text(encoding="utf-8") == written, "reading changes nothing"


@pytest.mark.parametrize("cut", [40, None])
def test_the_next_result_begins_on_a_line_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cut: int | None
) -> None:
    file = tmp_path / "results.jsonl"
    written = result_line("k") + "\n" + result_line("l")[:cut]
    file.write_text(written, encoding="utf-8")
    monkeypatch.setattr(
        "navette.navigation.bench.run.run_trial", lambda trial, load: result("b")
    )
    list(run_trials([TRIAL], jobs=1, results_file=file))
    kept = ["k"] if cut else ["k", "l"]
    assert list(read_results(file)) == [*kept, trial_key(TRIAL)]


@pytest.mark.parametrize(
    "content", [b'{"a":1}', b"one\ntwo", b"\x89PNG\r\n\xff", b'{"key": "k"}']
)
def test_a_file_without_results_is_refused_and_kept(
    tmp_path: Path, content: bytes
) -> None:
    file = tmp_path / "mine.json"
    file.write_bytes(content)
    with pytest.raises(FileFormatError, match=r"mine\.json.*not a result of navette"):
        read_results(file)
    with pytest.raises(FileFormatError, match=r"mine\.json.*not a result of navette"):
        list(run_trials([TRIAL], jobs=1, results_file=file))
    assert file.read_bytes() == content


def test_the_replay_command_repeats_the_drive() -> None:
    own = dataclasses.replace(
        TRIAL,
        seed=4,
        methods={"controller": "my file.py:Mine"},
        parameters={"control": {"gain": 2.0, "collision_check": False}},
    )
    assert replay_command(own) == (
        "navette sim rooms:3 --robot jackal --start -7.5 -7.5 28.6478897565 "
        "--goal 7.5,7.5 --seed 4 --controller 'my file.py:Mine' "
        "-p control.gain=2.0 -p control.collision_check=false"
    )


def test_the_report_draws_the_worst_worlds() -> None:
    own = result(suite="rooms", name="rooms-3")
    page = report_page("rooms", [ReportedRun.of("", [own], [TRIAL])], [])
    assert page.count("<polygon") > 10
    assert "navette sim rooms:3" in page


def test_a_trial_with_a_users_node_requires_a_loader() -> None:
    own = dataclasses.replace(TRIAL, replacements={"control": "mine.py:Mine"})
    with pytest.raises(InvalidValueError, match=r"control.*pass load_nodes"):
        run_trial(own)
