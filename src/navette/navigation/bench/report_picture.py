"""Pictures of trials for the report: the world, the driven path, and the command."""

import html
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from navette.navigation.bench.picture import obstacle_outlines
from navette.navigation.bench.replay_command import replay_command
from navette.navigation.bench.trial import Trial, TrialResult

# Around the path: the walls of a room in whose corners the robot starts and ends.
_PAD_M = 2.0
_SCALES_M = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)


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
    width = float(size.max()) / 100
    below = 6 * width  # for the scale
    view = f"{low[0]:.2f} {low[1]:.2f} {size[0]:.2f} {size[1] + below:.2f}"
    (x, y), (end_x, end_y) = points[0], points[-1]
    marks = f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{2 * width:.3f}"/>'
    marks += "".join(_cross(*goal, 2 * width) for goal in goals)
    line = " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
    command = ""
    if trial is not None:
        text = html.escape(replay_command(trial))
        command = f'<div class="command"><code>{text}</code><button>copy</button></div>'
    kind = "good" if result.succeeded else "bad"
    return (
        f'<figure><svg viewBox="{view}" role="img" aria-label="world and driven path">'
        f'<g class="world">{_polygons(outlines, low, high)}</g>'
        f'<polyline class="path" points="{line}" stroke-width="{width:.3f}"/>'
        f'<circle class="end" cx="{end_x:.2f}" cy="{end_y:.2f}" r="{1.6 * width:.3f}"/>'
        f'<g class="mark" stroke-width="{width:.3f}">{marks}</g>'
        f"{_scale_bar(low, high, width)}</svg><figcaption>"
        f"<div><strong>{html.escape(result.name)}</strong>, seed {result.seed} "
        f'<span class="badge {kind}">{html.escape(result.outcome)}</span></div>'
        f"<small>{_measures(result)}</small>{command}</figcaption></figure>"
    )


def _measures(result: TrialResult) -> str:
    """Return time, score and the two largest losses of a trial."""
    parts = [f"{result.time_s:.1f} s", f"score {result.score:.3f}"]
    worst = sorted(result.lost_s.items(), key=lambda each: -each[1])[:2]
    lost = [f"{s:.1f} s {name.replace('_', ' ')}" for name, s in worst if s >= 0.1]
    if lost:
        parts.append("lost " + html.escape(", ".join(lost)))
    return " · ".join(parts)


def _scale_bar(
    low: NDArray[np.float64], high: NDArray[np.float64], width: float
) -> str:
    """Return a bar of a round length, at most a third of the picture, in its corner."""
    edge = float(high[0] - low[0])
    fitting = [each for each in _SCALES_M if each <= edge / 3]
    length = fitting[-1] if fitting else _SCALES_M[0]
    x, y = low[0] + width, high[1] + 4 * width
    return (
        f'<path class="scale" d="M{x:.2f} {y:.2f}h{length}" stroke-width="{width}"/>'
        f'<text x="{x + length + 2 * width:.2f}" y="{y + 1.2 * width:.2f}" '
        f'font-size="{4 * width:.3f}">'
        f"{length:g} m</text>"
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
