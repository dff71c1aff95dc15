"""The report of a benchmark as one HTML file without references to other files."""

import html
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version

from navette.navigation.bench.replay_command import replay_command
from navette.navigation.bench.report_picture import trial_figure
from navette.navigation.bench.report_style import SCRIPT, STYLE
from navette.navigation.bench.statistics import MeasureDifference, Summary, summarize
from navette.navigation.bench.trial import Trial, TrialResult

_WORST = 12
_PRINTED = 5  # failed trials, on the terminal
_LEAST_SHOWN = 0.005  # rounds to 0.01 s or %
_LABELS = {
    "time_s": "time, s",
    "path_m": "path, m",
    "jerk": "jerk, m/s³",
    "min_clearance_m": "clearance, m",
}


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
        f'<p class="lead">{html.escape(_setting(mine))}</p>',
        *(_figures(each.summary, each.name) for each in runs),
        _comparison(comparisons),
        '<div class="pair">',
        _losses(runs),
        _cpu(runs),
        "</div>",
        "<h2>Worst trials</h2>",
        '<p class="lead">Obstacles at the start, start (ring), goal (cross), driven '
        "path and its end (dot). The command drives the trial again in the live "
        "view.</p>",
        '<div class="tracks">',
        *(trial_figure(each, mine.trial_of(each)) for each in worst[:_WORST]),
        "</div>",
        "<h2>All trials</h2>",
        _table(mine.results),
        '<p class="lead foot">Simulated by Navette; scores of other simulators, and of '
        "the BARN challenge's leaderboard, are not comparable with these.</p>",
    ]
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{html.escape(title)}</title><style>{STYLE}</style>"
        f"<body>{''.join(parts)}<script>{SCRIPT}</script></body></html>\n"
    )


def _setting(run: ReportedRun) -> str:
    """Return robot, number of worlds and seeds, and what was chosen."""
    parts = [
        _counted("world", len({each.name for each in run.results})),
        _counted("seed", len({each.seed for each in run.results})),
    ]
    trial = next(iter(run.trials.values()), None)
    if trial is not None:
        parts.insert(0, trial.robot or "the worlds' own robots")
        parts += [f"{kind} {name}" for kind, name in trial.methods.items()]
        parts += [f"{node} {place}" for node, place in trial.replacements.items()]
        parts += [
            f"{node}.{name}={value}"
            for node, values in trial.parameters.items()
            for name, value in values.items()
        ]
    return " · ".join([*parts, f"Navette {version('navette')}"])


def _counted(noun: str, count: int) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _figures(summary: Summary, name: str) -> str:
    low, high = 100 * summary.success_low, 100 * summary.success_high
    rows = {
        "success": (f"{100 * summary.success:.1f} %", f"95 %: {low:.0f}–{high:.0f} %"),
        "contacts": (f"{summary.contacts}", _counted("trial", summary.trials)),
        "score": (f"{summary.score:.4f}", "of 0.5"),
        "time": (f"{_known(summary.time_s, 1)} s", "mean of successes"),
        "path / shortest": (_known(summary.path_ratio, 2), "mean of successes"),
        "clearance": (f"{_known(summary.min_clearance_m, 3)} m", "least of all trials"),
        "jerk": (f"{_known(summary.jerk, 1)} m/s³", "lower is smoother"),
    }
    cells = (
        f"<div><dt>{label}</dt><dd>{value}<small>{note}</small></dd></div>"
        for label, (value, note) in rows.items()
    )
    heading = f"<h2>{html.escape(name)}</h2>" if name else ""
    return f"{heading}<dl>{''.join(cells)}</dl>{_outcomes(summary)}"


def _outcomes(summary: Summary) -> str:
    """Return a bar with a part for each outcome, successes first, and its legend."""
    ordered = sorted(summary.outcomes.items(), key=lambda each: each[0] != "reached")
    parts = "".join(
        f'<i class="{_kind(name)}" style="flex:{count}"></i>' for name, count in ordered
    )
    legend = "".join(
        f'<span><i class="{_kind(name)}"></i>{html.escape(name)} {count}</span>'
        for name, count in ordered
    )
    return f'<div class="outcomes">{parts}</div><p class="legend">{legend}</p>'


def _kind(outcome: str) -> str:
    return "good" if outcome == "reached" else "bad"


def _losses(runs: Sequence[ReportedRun]) -> str:
    rows = {each.name: each.summary.lost_s for each in runs}
    return f"<section><h2>Time lost per trial, s</h2>{_bars('cause', rows)}</section>"


def _cpu(runs: Sequence[ReportedRun]) -> str:
    """Return the CPU time of each node, in percent of the simulated time."""
    rows = {
        each.name: {k: 100 * v for k, v in each.summary.cpu_share.items()}
        for each in runs
    }
    heading = "<h2>CPU per node, % of real time</h2>"
    return f"<section>{heading}{_bars('node', rows)}</section>"


def _bars(heading: str, columns: Mapping[str, Mapping[str, float]]) -> str:
    """Return a table of one number per row and column, with bars for the last."""
    last = list(columns.values())[-1]
    names = dict.fromkeys(
        [*last, *(name for each in columns.values() for name in each)]
    )
    most = max((abs(value) for value in last.values()), default=0.0) or 1.0
    head = "".join(f"<th>{html.escape(name) or 'mean'}</th>" for name in columns)
    rows = "".join(
        f"<tr><td>{html.escape(name.replace('_', ' '))}</td>"
        + "".join(f"<td>{each.get(name, 0.0):.2f}</td>" for each in columns.values())
        + f'<td class="wide">{_bar(last.get(name, 0.0) / most)}</td></tr>'
        for name in names
        if any(abs(each.get(name, 0.0)) >= _LEAST_SHOWN for each in columns.values())
    )
    return _scrolled(f"<tr><th>{heading}</th>{head}<th></th></tr>{rows}")


def _bar(share: float) -> str:
    return f'<div class="bar" style="width:{100 * max(0.0, share):.0f}%"></div>'


def _scrolled(rows: str) -> str:
    """Return a table that a narrow screen scrolls."""
    return f'<div class="scroll"><table>{rows}</table></div>'


def _comparison(comparisons: Sequence[MeasureDifference]) -> str:
    if not comparisons:
        return ""
    rows = "".join(
        f"<tr><td>{_LABELS.get(each.measure, each.measure)}</td>"
        f"<td>{each.difference:+.4f}</td>"
        f"<td>{each.low:+.4f} … {each.high:+.4f}</td>"
        f"<td>{each.p_value:.4f}</td><td>{each.pairs}</td><td>{_verdict(each)}</td></tr>"
        for each in comparisons
    )
    return "<h2>Mine − baseline</h2>" + _scrolled(
        "<tr><th>measure</th><th>mean difference</th><th>95 % interval</th><th>p</th>"
        f"<th>pairs</th><th></th></tr>{rows}"
    )


def _verdict(difference: MeasureDifference) -> str:
    if difference.is_worse:
        return '<span class="badge bad">worse</span>'
    if difference.is_better:
        return '<span class="badge good">better</span>'
    return '<span class="badge">no clear difference</span>'


def _table(results: Sequence[TrialResult]) -> str:
    rows = "".join(
        f"<tr><td>{html.escape(each.name)}</td><td>{each.seed}</td>"
        f'<td><span class="badge {_kind(each.outcome)}">{html.escape(each.outcome)}'
        f"</span></td><td>{each.time_s:.1f}</td>"
        f"<td>{each.score:.3f}</td><td>{_ratio(each)}</td>"
        f"<td>{each.contacts}</td><td>{_metres(each.min_clearance_m)}</td></tr>"
        for each in results
    )
    head = "".join(
        f"<th>{name}</th>"
        for name in ("trial", "seed", "outcome", "time, s", "score",
                     "path / shortest", "contacts", "clearance, m")
    )  # fmt: skip
    return _scrolled(f"<tr>{head}</tr>{rows}")


def _ratio(result: TrialResult) -> str:
    return _known(result.path_ratio, 2)


def _metres(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _known(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"
