"""The how-to lists the parameters; the example's policy drives in the whole stack."""

import dataclasses
import runpy
from pathlib import Path

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.bench.run import run_trial
from navette.navigation.bench.trial import Trial
from navette.navigation.gym import NavigationEnvParams
from navette.params import info_of

ROOT = Path(__file__).parents[4]
EXAMPLE = ROOT / "examples" / "32_train_a_policy.py"


def test_the_page_lists_every_parameter() -> None:
    page = (ROOT / "docs" / "howto" / "train.md").read_text(encoding="utf-8")
    for field in dataclasses.fields(NavigationEnvParams):
        info = info_of(field)
        unit = f" {info.unit}" if info.unit else ""
        assert f"| `{field.name}` | {field.default}{unit} | {info.meaning} |" in page


@pytest.mark.slow
def test_a_policy_drives_in_the_whole_stack(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    example = runpy.run_path(str(EXAMPLE))
    np.savez(tmp_path / "policy.npz", weights=example["first_weights"]())
    monkeypatch.setenv("POLICY", str(tmp_path / "policy.npz"))
    method = {"method": f"{EXAMPLE}:LearnedController"}
    trial = Trial(
        suite="own",
        name="empty",
        world="empty",
        robot="jackal",
        start=Pose2(0.0, 0.0, 0.0),
        goals=((4.0, 2.0),),
        reach_m=1.0,
        limit_s=20.0,
        parameters={"control": method},
    )
    result = run_trial(trial)
    assert result.outcome == "reached"
    assert result.path_m < 5.5
