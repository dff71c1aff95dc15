"""Click parameters declared by annotations: ``Annotated[int, Option("--count")]``.

A parameter whose type is a dataclass is an option group: each field of the dataclass is
a parameter of the command. Groups can contain groups::

    @dataclass(frozen=True, kw_only=True)
    class EchoOptions:
        topic: TopicName
        once: Annotated[bool, Option("--once")] = False
        qos: QosOverrides = field(default_factory=QosOverrides)

    @topic.command()
    def echo(options: EchoOptions) -> None: ...
"""

import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

import click
from click.shell_completion import CompletionItem

Completer = Callable[..., list[str]]
"""Returns the completions of a word; takes the word, or the click context and it."""


@dataclass(frozen=True, kw_only=True)
class Argument:
    """A positional argument."""

    metavar: str | None = None
    help: str = ""
    complete: Completer | None = None
    type: click.ParamType[Any] | None = None


class Option:
    """An option. Without ``flags`` its name is that of the Python parameter.

    Args:
        variable: environment variable with the value, if the option is not given.
        takes_words: ``--topics a b`` are two values, as in ROS 2's command; click takes
            one value per option.
    """

    def __init__(
        self,
        *flags: str,
        help: str = "",
        metavar: str | None = None,
        min: float | None = None,
        max: float | None = None,
        complete: Completer | None = None,
        panel: str = "Options",
        variable: str | None = None,
        takes_words: bool = False,
    ) -> None:
        self.flags = flags
        self.help = help
        self.metavar = metavar
        self.min = min
        self.max = max
        self.complete = complete
        self.panel = panel
        self.variable = variable
        self.takes_words = takes_words


Json = Annotated[bool, Option("--json", help="Print JSON.")]
HiddenNodes = Annotated[
    bool, Option("--include-hidden-nodes", help="Include hidden nodes (_name).")
]
AllNodes = Annotated[bool, Option("--all", "-a", help="Include hidden nodes (_name).")]
CountNodes = Annotated[
    bool, Option("--count-nodes", "-c", help="Print only the number.")
]
Stdin = Annotated[bool, Option("--stdin", help="Read the YAML from standard input.")]


class PanelOption(click.Option):
    """An option that the help page lists under a heading of its own."""

    def __init__(
        self, *args: Any, panel: str, takes_words: bool = False, **attributes: Any
    ) -> None:
        super().__init__(*args, **attributes)
        self.panel = panel
        self.takes_words = takes_words


def click_parameters(function: Callable[..., Any]) -> Iterator[click.Parameter]:
    """Yield the click parameters of an annotated function or dataclass."""
    for each in inspect.signature(function, eval_str=True).parameters.values():
        if is_dataclass(each.annotation):
            group: Any = each.annotation
            yield from click_parameters(group)
        else:
            yield _click_parameter(each)


def call_arguments(
    function: Callable[..., Any], values: dict[str, Any]
) -> dict[str, Any]:
    """Return the keyword arguments of a function from the values that click parsed."""
    arguments = {}
    for name, each in inspect.signature(function, eval_str=True).parameters.items():
        if is_dataclass(each.annotation):
            group: Any = each.annotation
            arguments[name] = group(**call_arguments(group, values))
        else:
            value = values[name]
            is_list = get_origin(_declared_type(each)) is list
            # Click gives a tuple, empty where the option was not given.
            arguments[name] = (list(value or ()) or each.default) if is_list else value
    return arguments


def _click_parameter(parameter: inspect.Parameter) -> click.Parameter:
    declaration = get_args(parameter.annotation)[1]
    kind = _declared_type(parameter)
    is_list = get_origin(kind) is list
    attributes: dict[str, Any] = {
        "type": _click_type(get_args(kind)[0] if is_list else kind, declaration),
        "metavar": declaration.metavar,
        "help": declaration.help,
        "shell_complete": _shell_complete(declaration.complete),
    }
    if parameter.default is inspect.Parameter.empty:
        attributes["required"] = True
    elif not is_list:
        attributes["default"] = parameter.default
    if isinstance(declaration, Argument):
        metavar = declaration.metavar or parameter.name.upper()
        if "required" not in attributes and not metavar.startswith("["):
            attributes["metavar"] = f"[{metavar}]"
        attributes.setdefault("required", False)
        return click.Argument(
            [parameter.name], nargs=-1 if is_list else None, **attributes
        )
    flags = declaration.flags or (f"--{parameter.name.replace('_', '-')}",)
    return PanelOption(
        [parameter.name, *flags],
        panel=declaration.panel,
        envvar=declaration.variable,
        show_envvar=declaration.variable is not None,  # in errors
        takes_words=declaration.takes_words,
        multiple=is_list,
        is_flag=True if kind is bool else None,  # False: the value is optional
        show_default=kind is not bool and parameter.default not in (None, ""),
        **attributes,
    )


def _declared_type(parameter: inspect.Parameter) -> Any:
    """The type without ``Annotated`` and without ``| None``."""
    kind = get_args(parameter.annotation)[0]
    if get_origin(kind) in (Union, UnionType):
        (kind,) = (each for each in get_args(kind) if each is not type(None))
    return kind


def _click_type(kind: Any, declaration: Argument | Option) -> Any:
    if isinstance(declaration, Argument):
        if declaration.type is not None:
            return declaration.type
    elif declaration.min is not None or declaration.max is not None:
        limits: tuple[Any, Any] = declaration.min, declaration.max
        return click.IntRange(*limits) if kind is int else click.FloatRange(*limits)
    if kind is Path:
        return click.Path(path_type=Path)
    return get_args(kind) if get_origin(kind) is tuple else kind


def _shell_complete(complete: Completer | None) -> Any:
    if complete is None:
        return None
    takes_context = len(inspect.signature(complete).parameters) > 1

    def shell_complete(
        ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        found = complete(ctx, incomplete) if takes_context else complete(incomplete)
        # Without a completion the shell offers files.
        items = [CompletionItem(each) for each in found]
        return items or [CompletionItem(incomplete, type="file")]

    return shell_complete
