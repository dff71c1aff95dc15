"""``navette completion``: let the shell complete verbs, topics, nodes and the rest.

The scripts call ``navette`` with what is typed in variables of the environment and get
words back; Typer understands those variables once its completion is switched on.
"""

import os
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from navette.cli.output import note, show
from navette.cli.session import fail

VARIABLE = "_NAVETTE_COMPLETE"

_BASH = """\
_navette_completion() {
    local IFS=$'\\n'
    COMPREPLY=($(COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD \\
        _NAVETTE_COMPLETE=complete_bash "$1" 2>/dev/null))
}
complete -o default -F _navette_completion navette
"""
# Words come as for fish, a line each with its help: Typer's own answer to zsh is a
# program to run, made of names that strangers chose.
_ZSH = """\
#compdef navette
(( $+functions[compdef] )) || { autoload -Uz compinit && compinit }
_navette_completion() {
    local line value
    local -a words_and_help values
    for line in "${(@f)$(_TYPER_COMPLETE_ARGS="${words[1,$CURRENT]}" \\
        _TYPER_COMPLETE_FISH_ACTION=get-args _NAVETTE_COMPLETE=complete_fish \\
        navette 2>/dev/null)}"; do
        value="${line%%$'\\t'*}"
        if [[ "$value" == *' '* ]]; then
            values+=("${(qqq)value}")
        elif [[ "$line" == *$'\\t'* ]]; then
            words_and_help+=("${value//:/\\\\:}:${line#*$'\\t'}")
        elif [[ -n "$value" ]]; then
            words_and_help+=("${value//:/\\\\:}")
        fi
    done
    (( $#values )) && compadd -Q -S '' -- "${values[@]}"
    (( $#words_and_help )) && _describe navette words_and_help
    (( $#values + $#words_and_help )) || _files
}
compdef _navette_completion navette
"""
_FISH = """\
function _navette_completion
    set --local words (env _NAVETTE_COMPLETE=complete_fish \\
        _TYPER_COMPLETE_FISH_ACTION=get-args \\
        _TYPER_COMPLETE_ARGS=(commandline -cp) navette 2>/dev/null)
    if test -n "$words"
        printf '%s\\n' $words
    else
        __fish_complete_path (commandline -ct)
    end
end
complete --command navette --no-files --arguments "(_navette_completion)"
"""


class Shell(StrEnum):
    """Those that can be taught."""

    BASH = "bash"
    ZSH = "zsh"
    FISH = "fish"


SCRIPTS = {Shell.BASH: _BASH, Shell.ZSH: _ZSH, Shell.FISH: _FISH}

# Where a shell looks for what it reads at its start.
_SETTINGS = {Shell.BASH: ".bashrc", Shell.ZSH: ".zshrc"}


def completion(
    shell: Annotated[
        Shell | None,
        typer.Argument(metavar="[bash|zsh|fish]", help="By default that of $SHELL."),
    ] = None,
    install: Annotated[
        bool, typer.Option("--install", help="Add it to the shell's settings.")
    ] = False,
) -> None:
    """Teach the shell to complete navette's words at Tab.

    For this terminal: [bold]eval "$(navette completion bash)"[/bold]; for every new
    one: [bold]navette completion --install[/bold].
    """
    chosen = shell or _own_shell()
    if not install:
        show(SCRIPTS[chosen].rstrip("\n"))
        return
    for path in install_script(chosen, Path.home()):
        show(f"wrote {path}")
    note("open a new terminal to have it")


def _own_shell() -> Shell:
    name = Path(os.environ.get("SHELL", "")).name
    if name not in list(Shell):
        fail(f"$SHELL is {name or 'not set'}; say which: {', '.join(Shell)}")
    return Shell(name)


def install_script(shell: Shell, home: Path) -> list[Path]:
    """Write the script, and where the shell does not look for it, a line that reads it.

    Doing it again changes nothing. Gives the files that were written.
    """
    folder = home / ".config" / ("fish/completions" if shell == "fish" else "navette")
    script = folder / ("navette.fish" if shell == "fish" else f"completion.{shell}")
    folder.mkdir(parents=True, exist_ok=True)
    script.write_text(SCRIPTS[shell], encoding="utf-8")
    if shell not in _SETTINGS:
        return [script]
    settings = home / _SETTINGS[shell]
    line = f"source '{script}'"
    text = settings.read_text(encoding="utf-8") if settings.is_file() else ""
    if line in text.splitlines():
        return [script]
    gap = "" if not text or text.endswith("\n") else "\n"
    settings.write_text(f"{text}{gap}{line}\n", encoding="utf-8")
    return [script, settings]


def is_completing() -> bool:
    """Whether it is the shell that asks for words."""
    return VARIABLE in os.environ


def keep_quiet() -> None:
    """Say nothing beside the words: it would be printed into a half typed line."""
    sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115 - until the process ends
