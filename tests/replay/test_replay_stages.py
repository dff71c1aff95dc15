"""Every stage reproduces the outputs in its golden bag."""

from pathlib import Path

import pytest
from make_golden import LONGEST_BYTES
from stages import STAGES, Stage, replay

from navette.navigation.costmap.node import CostmapNode
from navette.runtime import Context, Node

by_name = pytest.mark.parametrize("stage", STAGES, ids=lambda stage: stage.name)


@by_name
def test_a_stage_gives_its_golden_results(stage: Stage, tmp_path: Path) -> None:
    comparison = replay(stage, tmp_path / "out.mcap")
    assert {t.name for t in comparison.topics} == set(stage.outputs)
    assert all(topic.compared > 0 for topic in comparison.topics)
    assert comparison.same, [t for t in comparison.topics if not t.same]


@by_name
def test_two_replays_write_the_same_bytes(stage: Stage, tmp_path: Path) -> None:
    replay(stage, tmp_path / "a.mcap")
    replay(stage, tmp_path / "b.mcap")
    written = (tmp_path / "a.mcap").read_bytes()
    assert written == (tmp_path / "b.mcap").read_bytes()
    assert len(written) > 1000


@by_name
def test_golden_bags_stay_small(stage: Stage) -> None:
    assert stage.bag.stat().st_size < LONGEST_BYTES


@pytest.mark.parametrize(
    ("name", "argument", "field"),
    [
        ("costmap", "costmap:inflation_radius_m:=0.5", "data[]"),
        ("control", "control:cruise_speed_mps:=0.5", "linear.x"),
    ],
)
def test_a_changed_parameter_is_detected(
    name: str, argument: str, field: str, tmp_path: Path
) -> None:
    (stage,) = (each for each in STAGES if each.name == name)
    comparison = replay(stage, tmp_path / "out.mcap", arguments=("-p", argument))
    assert not comparison.same
    assert any(field in topic.fields for topic in comparison.topics)


def test_a_changed_algorithm_is_detected(tmp_path: Path) -> None:
    class Blind(CostmapNode):
        def on_scan(self, msg: object) -> None:
            """Omit every second message."""
            self.deaf = not getattr(self, "deaf", False)
            if not self.deaf:
                super().on_scan(msg)  # type: ignore[arg-type]

    stage = STAGES[0]

    def make(context: Context) -> Node:
        return Blind(context=context)

    for topic in replay(stage, tmp_path / "out.mcap", make=make).topics:
        assert topic.missing == topic.compared == 50
        assert topic.differing == 0
