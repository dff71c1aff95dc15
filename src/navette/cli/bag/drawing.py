"""Draw series with matplotlib: over time in panels, or field over field in a plane."""

from collections.abc import Sequence
from itertools import cycle
from pathlib import Path
from typing import Any

from navette.cli.bag.series import Series
from navette.errors import InvalidValueError, MissingPartError
from navette.files.writing import writing

SUFFIXES = (".png", ".svg", ".pdf")
# The live view's colours, distinguishable without colour vision.
_COLOURS = ("#bf3e0a", "#0b7285", "#5f3dc4", "#1f8a4c", "#b7791f", "#67707b")
_INK, _QUIET, _LINE = "#1c2025", "#67707b", "#e4e0d8"
_STYLE: Any = {
    "font.size": 9.5,
    "axes.edgecolor": _LINE,
    "axes.labelcolor": _QUIET,
    "axes.titlecolor": _INK,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": _LINE,
    "grid.linewidth": 0.6,
    "xtick.color": _QUIET,
    "ytick.color": _QUIET,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
    "lines.linewidth": 1.4,
    "axes.formatter.useoffset": False,  # UTM coordinates in full
    "axes.formatter.limits": (-4, 9),
    "legend.frameon": False,
    "svg.hashsalt": "navette",  # makes the file reproducible
}


def draw(series: Sequence[Series], title: str, path: Path) -> None:
    """Write a picture of the series.

    Raises:
        InvalidValueError: unknown suffix, or series of both kinds.
        MissingPartError: matplotlib is not installed.
        FileFormatError: the file cannot be written.
    """
    if path.suffix not in SUFFIXES:
        raise InvalidValueError(f"{path}: the suffix is not {' or '.join(SUFFIXES)}")
    if len({bool(each.selected.x) for each in series}) > 1:
        raise InvalidValueError(
            "fields over time and fields over each other (with a colon) cannot be in"
            " one picture; make two"
        )
    try:
        from matplotlib import rc_context
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingPartError.of("plotting", "matplotlib", "plot") from error
    with rc_context(_STYLE):
        figure = Figure(layout="constrained", dpi=144)
        paint = _paint_plane if series[0].selected.x else _paint_panels
        paint(figure, series)
        figure.suptitle(title, x=0.01, ha="left", color=_INK, weight="bold", size=11)
        metadata: dict[str, None] = {
            ".png": {"Software": None},
            ".svg": {"Date": None},
            ".pdf": {"CreationDate": None},
        }[path.suffix]
        with writing(path):
            figure.savefig(path, metadata=metadata)


def _paint_panels(figure: Any, series: Sequence[Series]) -> None:
    """Draw a panel for each field name with a common time axis."""
    panels: dict[str, list[Series]] = {}
    for each in series:
        panels.setdefault(each.selected.y.rpartition(".")[2], []).append(each)
    figure.set_size_inches(9.0, 0.9 + 2.3 * len(panels))
    axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    colours = cycle(_COLOURS)
    for axis, lines in zip(axes, panels.values(), strict=True):
        for each in lines:
            axis.plot(each.x, each.y, color=next(colours), label=_label(each))
        _name(axis, lines)
        axis.margins(x=0.0)
    axes[-1].set_xlabel("seconds since the start of the recording")


def _paint_plane(figure: Any, series: Sequence[Series]) -> None:
    """Draw all lines in one plane with equal scales."""
    figure.set_size_inches(7.2, 6.2)
    axis = figure.subplots()
    alike = (
        len({(each.selected.x, each.selected.y) for each in series}) == 1 < len(series)
    )
    for each, colour in zip(series, cycle(_COLOURS), strict=False):
        # The axes name common fields.
        label = each.selected.topic if alike else _label(each)
        axis.plot(each.x, each.y, color=colour, label=label)
        axis.plot(each.x[0], each.y[0], "o", color=colour, markersize=4.5)
    _name(axis, series)
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_xlabel(series[0].selected.x)
    axis.set_ylabel(series[0].selected.y)


def _name(axis: Any, lines: Sequence[Series]) -> None:
    """Set the title for one line, a legend for several."""
    if len(lines) == 1:
        axis.set_title(_label(lines[0]))
    else:
        # Above the lines: within the axes it would cover some of them.
        axis.legend(
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            borderpad=0.0,
            borderaxespad=0.5,
            handlelength=1.2,
            ncols=min(len(lines), 2),
            labelcolor=_INK,
        )


def _label(series: Series) -> str:
    selected = series.selected
    over = f" over {selected.x}" if selected.x else ""
    note = f" ({series.note})" if series.note else ""
    return f"{selected.topic}  {selected.y}{over}{note}"
