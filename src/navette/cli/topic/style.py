"""How ``topic echo`` prints messages."""

from dataclasses import dataclass
from typing import Annotated

import typer


@dataclass(frozen=True, kw_only=True)
class Style:
    """Lengths are in items or characters, None = whole."""

    csv: Annotated[
        bool, typer.Option("--csv", help="A line of values with commas between.")
    ] = False
    as_json: Annotated[
        bool,
        typer.Option("--json", help="A line of JSON each, arrays whole, null for NaN."),
    ] = False
    no_arr: Annotated[
        bool, typer.Option("--no-arr", help="Arrays only by type and length.")
    ] = False
    no_str: Annotated[bool, typer.Option("--no-str", help="Texts only by length.")] = (
        False
    )
    flow_style: Annotated[
        bool, typer.Option("--flow-style", help="Each message on one line.")
    ] = False
    truncate_length: Annotated[
        int | None,
        typer.Option(
            "--truncate-length",
            "-l",
            min=0,
            metavar="N",
            help="Items shown of arrays and texts.",
        ),
    ] = 128
    full_length: Annotated[
        bool, typer.Option("--full-length", "-f", help="Arrays and texts whole.")
    ] = False
