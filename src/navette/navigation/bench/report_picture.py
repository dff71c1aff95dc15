"""Pictures of trials for the report: the world, the driven path, and the command."""

import html
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from navette.navigation.bench.picture import obstacle_outlines
from navette.navigation.bench.replay_command import replay_command
from navette.navigation.bench.trial import Trial, TrialResult

_PAD_M = 1.0


def trial_figure(result: TrialResult, trial: Trial | None) -> str:
    """Return the picture of a trial with its caption, as HTML."""
    points = [(x, -y) for x, y in result.track]
    if not points:
        return ""
    outlines = [] if trial is None else obstacle_outlines(trial)
    goals = [] if trial is None else [(x, -y) for x, y in trial.goals]
    shown = np.array([*points, *goals])
    low, high = shown.min(axis=0) - _PAD_M, shown.max(axis=0) + _PAD_M
    size = high - low
    width = float(size.max()) / 90
    view = f"{low[0]:.2f} {low[1]:.2f} {size[0]:.2f} {size[1]:.2f}"
    x, y = points[0]
    marks = f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{2 * width:.3f}"/>'
    marks += "".join(_cross(*goal, 2 * width) for goal in goals)
    line = " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
    command = ""
    if trial is not None:
        command = f"<br><code>{html.escape(replay_command(trial))}</code>"
    return (
        f'<figure><svg viewBox="{view}" role="img" aria-label="world and driven path">'
        f'<g class="world">{_polygons(outlines, low, high)}</g>'
        f'<g class="mark" stroke-width="{width:.3f}">{marks}</g>'
        f'<polyline points="{line}" fill="none" stroke="var(--accent)" '
        f'stroke-width="{width:.3f}"/></svg><figcaption>'
        f"<strong>{html.escape(result.name)}</strong>, seed {result.seed}: "
        f"{html.escape(result.outcome)}, {result.time_s:.1f} s{command}"
        "</figcaption></figure>"
    )


def _polygons(
    outlines: Sequence[NDArray[np.float64]],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> str:
    """Return the outlines that lie in the picture, y down."""
    parts = []
    for outline in outlines:
        corners = outline * (1.0, -1.0)
        if (corners.max(axis=0) < low).any() or (corners.min(axis=0) > high).any():
            continue
        text = " ".join(f"{x:.2f},{y:.2f}" for x, y in corners.tolist())
        parts.append(f'<polygon points="{text}"/>')
    return "".join(parts)


def _cross(x: float, y: float, half: float) -> str:
    a, b, c, d = (f"{v:.2f}" for v in (x - half, x + half, y - half, y + half))
    return f'<path d="M{a} {c}L{b} {d}M{a} {d}L{b} {c}"/>'
