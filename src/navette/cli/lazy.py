"""Verbs that are imported when they are called, so that each starts at once.

Typer builds every command with all of its options before it runs one; for some
seventy commands that takes longer than most of them do.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_group

from navette.cli.garbage import collect
from navette.cli.interruption import raise_at_interrupt

_PLAIN = (str, int, float, bool)


class Later(NamedTuple):
    """A command, or a group of them, that is not here yet.

    ``add`` adds it to the app that it is given; ``help`` is the first line of its help.
    ``only_looks``: Ctrl-C may end it at any time, until it joins what runs.
    """

    help: str
    add: Callable[[typer.Typer], object]
    only_looks: bool = False


class _Placeholder(TyperCommand):
    """Stands in lists of commands for one that is not here yet."""

    def __init__(self, name: str, later: Later) -> None:
        super().__init__(name, help=later.help)
        self._later = later
        self.only_looks = later.only_looks

    def load(self) -> Any:
        app = typer.Typer(add_completion=False, rich_markup_mode="rich")
        self._later.add(app)
        assert self.name is not None, "it was made with a name"
        command = get_group(app).commands[self.name]
        _take_plain_values_as_they_are(command)
        return command


def lazy_group(verbs: Mapping[str, Later]) -> type[TyperGroup]:
    """The class of a group that has these commands beside those it is given."""

    class LazyGroup(TyperGroup):
        def __init__(self, **attributes: Any) -> None:
            super().__init__(**attributes)
            _take_plain_values_as_they_are(self)
            for name, later in verbs.items():
                self.commands.setdefault(name, _Placeholder(name, later))

        def resolve_command(self, ctx: Any, args: list[str]) -> Any:
            name, command, rest = super().resolve_command(ctx, args)
            only_looks = isinstance(command, _Placeholder) and command.only_looks
            if isinstance(command, _Placeholder) and name is not None:
                command = self.commands[name] = command.load()
            if not only_looks:
                raise_at_interrupt()
                collect()
            return name, command, rest

    return LazyGroup


class _PlainValue:
    """Passes on what needs no conversion: nothing, words, and defaults.

    Typer's own conversion imports pydantic and builds a schema for each option, also
    for those that nobody gave: a tenth of a second for a verb with many.
    """

    def coerce(self, value: Any, param: Any, ctx: Any) -> Any:
        is_many = param.multiple or param.nargs == -1
        if value is None:
            return () if is_many else None
        kind = param.type_descriptor.annotation
        # What was typed is text; a value of another type is the option's default.
        if not is_many and type(value) is kind and kind in _PLAIN:
            return value
        if is_many and kind == list[str]:
            return list(value)
        param._runtime_param = None
        return param.get_runtime_param().coerce(value, param=param, ctx=ctx)


def _take_plain_values_as_they_are(command: Any) -> None:
    """For this command and all below it, where Typer converts in that way."""
    get_params = command.get_params

    def get_plain_params(ctx: Any) -> list[Any]:
        params: list[Any] = get_params(ctx)  # with --help, which is made here
        for param in params:
            if getattr(param, "_runtime_param", "") is None:
                param._runtime_param = _PlainValue()
            if getattr(param, "is_flag", False) and param.metavar is None:
                param.metavar = ""  # help would say <bool>, as if it took a value
        return params

    command.get_params = get_plain_params
    for each in getattr(command, "commands", {}).values():
        _take_plain_values_as_they_are(each)
