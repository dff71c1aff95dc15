"""Help of a command in rich panels."""

import inspect

import click
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from navette.cli.options import PanelOption


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


def _panels(
    command: click.Command, ctx: click.Context
) -> dict[str, list[list[RenderableType]]]:
    """Rows by the heading of their panel."""
    panels: dict[str, list[list[RenderableType]]] = {"Arguments": [], "Options": []}
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
            row: list[RenderableType] = [label, each.get_short_help_str(limit=200)]
            panels.setdefault(title, []).append(row)
    return {title: rows for title, rows in panels.items() if rows}


def _argument_row(param: click.Argument, ctx: click.Context) -> list[RenderableType]:
    text = Text.from_markup(param.help or "")
    if param.required:
        text.append(" [required]", style="dim red")
    return [Text(param.make_metavar(ctx), style="bold cyan"), text]


def _option_row(param: click.Option, ctx: click.Context) -> list[RenderableType]:
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
    return [
        Text(",".join(long), style="bold cyan"),
        Text(",".join(short), style="bold green"),
        Text(metavar, style="bold yellow"),
        text,
    ]


def _panel(title: str, rows: list[list[RenderableType]]) -> Panel:
    table = Table.grid(padding=(0, 2, 0, 0), expand=True)
    for _ in rows[0][:-1]:
        table.add_column()
    table.add_column(ratio=1)
    for row in rows:
        table.add_row(*row)
    return Panel(table, title=title, title_align="left", border_style="dim")
