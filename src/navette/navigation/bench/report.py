"""The report of a benchmark as one HTML file without references to other files."""

import html
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from navette.navigation.bench.replay_command import replay_command
from navette.navigation.bench.report_picture import trial_figure
from navette.navigation.bench.statistics import MeasureDifference, Summary, summarize
from navette.navigation.bench.trial import Trial, TrialResult

_WORST = 12
_PRINTED = 5  # failed trials, on the terminal
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
td.wide { width: 50%; }
.world { fill: var(--soft); } .mark { fill: none; stroke: var(--good); }
.bar { height: .5rem; background: var(--accent); border-radius: .25rem; }
.tracks { display: grid; gap: 1rem;
  grid-template-columns: repeat(auto-fill, minmax(16rem, 1fr)); }
figure { margin: 0; } svg { width: 100%; height: 16rem; border: 1px solid var(--line);
  border-radius: .4rem; } figcaption { font-size: .8rem; color: var(--soft); }
code { font-size: .75rem; overflow-wrap: anywhere; }
"""


@dataclass(frozen=True)
class ReportedRun:
    """Results of one of what is compared.

    Attributes:
        name: of the variant; "" without a comparison.
        results: every trial.
        summary: over all results.
        trials: suite, name and seed → trial, where it was driven now.
    """

    name: str
    results: Sequence[TrialResult]
    summary: Summary
    trials: Mapping[tuple[str, str, int], Trial]

    @classmethod
    def of(
        cls, name: str, results: Sequence[TrialResult], trials: Sequence[Trial]
    ) -> "ReportedRun":
        own = {(t.suite, t.name, t.seed): t for t in trials if t.variant == name}
        return cls(name, results, summarize(results), own)

    def failures(self) -> list[str]:
        """Return how the first failed trials ended, with what repeats each."""
        lines = []
        for each in self.results:
            trial = self.trial_of(each)
            if trial is not None and not each.succeeded:
                what = f"{each.name}, seed {each.seed}: {each.outcome}"
                lines.append(f"{what}\n  {replay_command(trial)}")
        return lines[:_PRINTED]

    def trial_of(self, result: TrialResult) -> Trial | None:
        """Return the trial of a result; None: the result was read from a file."""
        return self.trials.get((result.suite, result.name, result.seed))


def report_page(
    title: str, runs: Sequence[ReportedRun], comparisons: Sequence[MeasureDifference]
) -> str:
    """Return the page.

    Args:
        title: the suite.
        runs: one, or the baseline and mine, whose worst trials are drawn.
        comparisons: of two runs; empty for one.
    """
    mine = runs[-1]
    worst = sorted(mine.results, key=lambda r: (r.succeeded, r.score, -r.time_s))
    parts = [
        f"<h1>{html.escape(title)}</h1>",
        '<p class="lead">Simulated by Navette; a score of another simulator is not '
        "comparable with that of a leaderboard.</p>",
        *(_figures(each.summary, each.name) for each in runs),
        _comparison(comparisons),
        _losses(runs),
        _cpu(runs),
        "<h2>Worst trials</h2>",
        '<p class="lead">Obstacles at the start, start (ring), goal (cross) and driven '
        "path. The command drives the trial again in the live view.</p>",
        '<div class="tracks">',
        *(trial_figure(each, mine.trial_of(each)) for each in worst[:_WORST]),
        "</div>",
        "<h2>All trials</h2>",
        _table(mine.results),
    ]
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{html.escape(title)}</title><style>{_STYLE}</style>"
        f"<body>{''.join(parts)}</body></html>\n"
    )


def _figures(summary: Summary, name: str) -> str:
    low, high = 100 * summary.success_low, 100 * summary.success_high
    rows = {
        "trials": f"{summary.trials}",
        f"success (95 %: {low:.0f}–{high:.0f} %)": f"{100 * summary.success:.1f} %",
        "contacts": f"{summary.contacts}",
        "score": f"{summary.score:.4f}",
        "time": f"{_known(summary.time_s, 1)} s",
        "path / shortest": _known(summary.path_ratio, 2),
        "minimum clearance": f"{_known(summary.min_clearance_m, 3)} m",
        "jerk": f"{_known(summary.jerk, 2)} m/s³",
    }
    cells = (f"<div><dt>{k}</dt><dd>{v}</dd></div>" for k, v in rows.items())
    heading = f"<h2>{html.escape(name)}</h2>" if name else ""
    return f"{heading}<dl>{''.join(cells)}</dl>"


def _losses(runs: Sequence[ReportedRun]) -> str:
    rows = {each.name: each.summary.lost_s for each in runs}
    return "<h2>Time lost per trial, s</h2>" + _bars("cause", rows)


def _cpu(runs: Sequence[ReportedRun]) -> str:
    """Return the CPU time of each node, in percent of the simulated time."""
    rows = {
        each.name: {k: 100 * v for k, v in each.summary.cpu_share.items()}
        for each in runs
    }
    return "<h2>CPU per node, % of real time</h2>" + _bars("node", rows)


def _bars(heading: str, columns: Mapping[str, Mapping[str, float]]) -> str:
    """Return a table of one number per row and column, with bars for the last."""
    last = list(columns.values())[-1]
    names = dict.fromkeys(
        [*last, *(name for each in columns.values() for name in each)]
    )
    most = max((abs(value) for value in last.values()), default=0.0) or 1.0
    head = "".join(f"<th>{html.escape(name) or 'value'}</th>" for name in columns)
    rows = "".join(
        f"<tr><td>{html.escape(name)}</td>"
        + "".join(f"<td>{each.get(name, 0.0):.2f}</td>" for each in columns.values())
        + f'<td class="wide">{_bar(last.get(name, 0.0) / most)}</td></tr>'
        for name in names
    )
    return f"<table><tr><th>{heading}</th>{head}<th></th></tr>{rows}</table>"


def _bar(share: float) -> str:
    return f'<div class="bar" style="width:{100 * max(0.0, share):.0f}%"></div>'


def _comparison(comparisons: Sequence[MeasureDifference]) -> str:
    if not comparisons:
        return ""
    rows = "".join(
        f"<tr><td>{each.measure}{', worse' if each.is_worse else ''}</td>"
        f"<td>{each.difference:+.4f}</td>"
        f"<td>{each.low:+.4f} … {each.high:+.4f}</td>"
        f"<td>{each.p_value:.4f}</td><td>{each.pairs}</td></tr>"
        for each in comparisons
    )
    return (
        "<h2>Mine − baseline</h2><table><tr><th>measure</th><th>difference</th>"
        f"<th>95 % interval</th><th>p</th><th>pairs</th></tr>{rows}</table>"
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
    return _known(result.path_ratio, 2)


def _metres(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _known(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"
