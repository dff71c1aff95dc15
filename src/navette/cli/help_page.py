"""Help of a command in rich panels."""

import inspect

import click
from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from navette.cli.options import PanelOption

# Columns that names may take beside their text; the text of a longer one is below it.
_BESIDE = 32

Row = tuple[Text, Text]
"""A name with what follows it, and its text."""


def help_page(command: click.Command, ctx: click.Context) -> str:
    """Return the page; click removes the colours where the output is not a terminal."""
    console = Console(force_terminal=True, highlight=False)
    with console.capture() as capture:
        usage = Text.assemble(
            ("Usage: ", "yellow"),
            (ctx.command_path, "bold"),
            " ",
            " ".join(command.collect_usage_pieces(ctx)),
        )
        console.print(Padding(usage, 1))
        for paragraph in inspect.cleandoc(command.help or "").split("\n\n"):
            text = Text.from_markup(paragraph.replace("\n", " "))
            console.print(Padding(text, (0, 1, 1, 1)))
        for title, rows in _panels(command, ctx).items():
            console.print(_panel(title, rows))
    return capture.get().rstrip("\n")


def _panels(command: click.Command, ctx: click.Context) -> dict[str, list[Row]]:
    """Rows by the heading of their panel."""
    panels: dict[str, list[Row]] = {"Arguments": [], "Options": []}
    for param in command.get_params(ctx):
        if isinstance(param, click.Argument):
            panels["Arguments"].append(_argument_row(param, ctx))
        elif isinstance(param, click.Option):
            panel = param.panel if isinstance(param, PanelOption) else "Options"
            panels.setdefault(panel, []).append(_option_row(param, ctx))
    if isinstance(command, click.Group):
        width = max(map(len, command.commands), default=0)
        for name, each in command.commands.items():
            title = getattr(each, "panel", "Commands")
            label = Text(name.ljust(width), style="bold cyan")
            text = Text.from_markup(each.get_short_help_str(limit=200))
            panels.setdefault(title, []).append((label, text))
    return {title: rows for title, rows in panels.items() if rows}


def _argument_row(param: click.Argument, ctx: click.Context) -> Row:
    text = Text.from_markup(param.help or "")
    if param.required:
        text.append(" [required]", style="dim red")
    return Text(param.make_metavar(ctx), style="bold cyan"), text


def _option_row(param: click.Option, ctx: click.Context) -> Row:
    names = sorted(param.opts, key=len, reverse=True)
    long = [name for name in names if name.startswith("--")]
    short = [name for name in names if not name.startswith("--")]
    extra = param.get_help_extra(ctx)
    metavar = "" if param.is_flag else param.make_metavar(ctx).removesuffix(" RANGE")
    text = Text.from_markup(param.help or "")
    if "range" in extra:
        text.append(f" [{extra['range']}]", style="dim")
    if param.required:
        text.append(" [required]", style="dim red")
    elif "default" in extra and not param.is_flag and extra["default"]:
        text.append(f" [default: {extra['default']}]", style="dim")
    label = Text(", ").join(
        [Text(name, style="bold cyan") for name in long]
        + [Text(name, style="bold green") for name in short]
    )
    if metavar:
        label.append(f" {metavar}", style="yellow")
    return label, text


def _panel(title: str, rows: list[Row]) -> Panel:
    beside = [label.cell_len for label, _ in rows if label.cell_len <= _BESIDE]
    column = max(beside, default=_BESIDE)
    lines = Group(*(_lines(label, text, column) for label, text in rows))
    return Panel(lines, title=title, title_align="left", border_style="dim")


def _lines(label: Text, text: Text, column: int) -> RenderableType:
    """Return a label with its text beside it, or below if the column is too narrow."""
    is_long = label.cell_len > column
    table = Table.grid(padding=(0, 2, 0, 0), expand=True)
    table.add_column(width=column)
    table.add_column(ratio=1, overflow="fold")
    table.add_row(Text() if is_long else label, text)
    return Group(label, table) if is_long else table
