"""The report of a benchmark as one HTML file without references to other files."""

import html
import math
from collections.abc import Sequence

from navette.bench.statistics import MeasureDifference, Summary
from navette.bench.trial import TrialResult

_WORST = 12
_STYLE = """
:root { color-scheme: light dark; --ink: #1d2630; --soft: #66727f; --line: #d9dee3;
  --page: #fbfbfa; --accent: #c8553d; --good: #3b7d5a; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ec; --soft: #98a3ae;
  --line: #333c45; --page: #171c21; --good: #6fbf94; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink);
  background: var(--page); max-width: 62rem; margin: 2.5rem auto; padding: 0 1.25rem; }
h1 { font-size: 1.5rem; margin: 0 0 .25rem; }
h2 { font-size: 1.1rem; margin-top: 2rem; }
p.lead { color: var(--soft); margin: 0 0 1.5rem; }
dl { display: grid; grid-template-columns: repeat(auto-fit, minmax(8.5rem, 1fr));
  gap: 1rem; margin: 0; } dt { color: var(--soft); font-size: .8rem; }
dd { margin: 0; font-size: 1.35rem; font-variant-numeric: tabular-nums; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: .3rem .6rem;
  border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; } th { color: var(--soft);
  font-weight: 500; font-size: .8rem; }
.bar { height: .5rem; background: var(--accent); border-radius: .25rem; }
.tracks { display: grid; gap: 1rem;
  grid-template-columns: repeat(auto-fill, minmax(11rem, 1fr)); }
figure { margin: 0; } svg { width: 100%; height: 11rem; border: 1px solid var(--line);
  border-radius: .4rem; } figcaption { font-size: .8rem; color: var(--soft); }
code { font-size: .75rem; overflow-wrap: anywhere; }
"""


def report_page(
    title: str,
    summary: Summary,
    results: Sequence[TrialResult],
    comparisons: Sequence[MeasureDifference],
    replay: Sequence[str],
) -> str:
    """Return the page.

    Args:
        title: suite, robot and method.
        summary: over all results.
        results: every trial.
        comparisons: against a baseline; may be empty.
        replay: for each result the command that repeats it with the live view.
    """
    commands = dict(zip(map(id, results), replay, strict=True))
    worst = sorted(results, key=lambda r: (r.succeeded, r.score, -r.time_s))[:_WORST]
    parts = [
        f"<h1>{html.escape(title)}</h1>",
        '<p class="lead">Simulated by Navette; a score of another simulator is not '
        "comparable with that of a leaderboard.</p>",
        _figures(summary),
        _losses(summary),
        _comparison(comparisons),
        "<h2>Worst trials</h2>",
        '<div class="tracks">',
        *(_figure(each, commands[id(each)]) for each in worst),
        "</div>",
        "<h2>All trials</h2>",
        _table(results),
    ]
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{html.escape(title)}</title><style>{_STYLE}</style>"
        f"<body>{''.join(parts)}</body></html>\n"
    )


def _figures(summary: Summary) -> str:
    low, high = 100 * summary.success_low, 100 * summary.success_high
    rows = {
        "trials": f"{summary.trials}",
        f"success (95 %: {low:.0f}–{high:.0f} %)": f"{100 * summary.success:.1f} %",
        "contacts": f"{summary.contacts}",
        "score": f"{summary.score:.4f}",
        "time": f"{summary.time_s:.1f} s",
        "path / shortest": f"{summary.path_ratio:.2f}",
        "minimum clearance": f"{summary.min_clearance_m:.3f} m",
    }
    cells = (f"<div><dt>{k}</dt><dd>{v}</dd></div>" for k, v in rows.items())
    return f"<dl>{''.join(cells)}</dl>"


def _losses(summary: Summary) -> str:
    most = max((abs(v) for v in summary.lost_s.values()), default=0.0) or 1.0
    rows = "".join(
        f"<tr><td>{html.escape(cause)}</td><td>{seconds:.2f}</td><td>"
        f'<div class="bar" style="width:{100 * max(0.0, seconds) / most:.0f}%"></div>'
        "</td></tr>"
        for cause, seconds in summary.lost_s.items()
    )
    return (
        "<h2>Time lost per trial</h2><table><tr><th>cause</th><th>seconds</th>"
        f"<th></th></tr>{rows}</table>"
    )


def _comparison(comparisons: Sequence[MeasureDifference]) -> str:
    if not comparisons:
        return ""
    rows = "".join(
        f"<tr><td>{each.measure}</td><td>{each.difference:+.4f}</td>"
        f"<td>{each.p_value:.4f}</td><td>{each.pairs}</td></tr>"
        for each in comparisons
    )
    return (
        "<h2>Against the baseline</h2><table><tr><th>measure</th><th>difference</th>"
        f"<th>p</th><th>pairs</th></tr>{rows}</table>"
    )


def _figure(result: TrialResult, command: str) -> str:
    points = [(x, -y) for x, y in result.track]
    if not points:
        return ""
    xs, ys = zip(*points, strict=True)
    pad = 0.5
    box = (min(xs) - pad, min(ys) - pad, max(xs) - min(xs) + 2 * pad,
           max(ys) - min(ys) + 2 * pad)  # fmt: skip
    line = " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
    width = max(box[2], box[3]) / 90
    view = " ".join(f"{value:.2f}" for value in box)
    return (
        f'<figure><svg viewBox="{view}" role="img" aria-label="driven path">'
        f'<polyline points="{line}" fill="none" stroke="var(--accent)" '
        f'stroke-width="{width:.3f}"/></svg><figcaption>'
        f"<strong>{html.escape(result.name)}</strong>, seed {result.seed}: "
        f"{html.escape(result.outcome)}, {result.time_s:.1f} s<br>"
        f"<code>{html.escape(command)}</code></figcaption></figure>"
    )


def _table(results: Sequence[TrialResult]) -> str:
    rows = "".join(
        f"<tr><td>{html.escape(each.name)}</td><td>{each.seed}</td>"
        f"<td>{html.escape(each.outcome)}</td><td>{each.time_s:.1f}</td>"
        f"<td>{each.score:.3f}</td><td>{_ratio(each)}</td>"
        f"<td>{each.contacts}</td><td>{_metres(each.min_clearance_m)}</td></tr>"
        for each in results
    )
    head = "".join(
        f"<th>{name}</th>"
        for name in ("trial", "seed", "outcome", "time, s", "score",
                     "path / shortest", "contacts", "clearance, m")
    )  # fmt: skip
    return f"<table><tr>{head}</tr>{rows}</table>"


def _ratio(result: TrialResult) -> str:
    ratio = result.path_m / result.shortest_m
    return f"{ratio:.2f}" if math.isfinite(ratio) else "–"


def _metres(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"
