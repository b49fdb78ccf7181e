"""Scripts that complete command lines, from the tables of options."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from voxrt.cli.line.command_line import HELP_FLAGS, command_options, flags_of
from voxrt.cli.line.help_text import option_text
from voxrt.options.commands import COMMANDS
from voxrt.options.option import ARGUMENTS

if TYPE_CHECKING:
    from voxrt.options.option import Option


def completion_script(shell: str) -> str:
    """Return the script for ``bash``, ``zsh`` or ``fish``."""
    return {"bash": _bash, "zsh": _zsh, "fish": _fish}[shell]()


def _named(command: str) -> dict[str, Option]:
    return {name: one for name, one in command_options(command).items() if one.group != ARGUMENTS}


def _argument_choices(command: str) -> str:
    return " ".join(
        choice for one in command_options(command).values() if one.group == ARGUMENTS for choice in one.kind.choices
    )


def _summary(option: Option, command: str) -> str:
    """Return the first sentence of an option's text, without what shells act on."""
    text = re.split(r"(?<=[^.])\.(?: |$)", option_text(option, command_options(command)))[0]
    return re.sub(r"[][':\\\"`$]", "", text)


def _bash() -> str:
    flags, values = [], []
    for command in COMMANDS:
        options = _named(command)
        names = [flag for name, one in options.items() for flag in flags_of(name, one)]
        words = " ".join([*names, *HELP_FLAGS, _argument_choices(command)]).strip()
        flags.append(f'    {command}) words="{words}" ;;')
        for name, one in options.items():
            if not (one.kind.is_flag or one.kind.is_optional):
                patterns = "|".join(f"{command}:{flag}" for flag in flags_of(name, one))
                values.append(f'    {patterns}) words="{" ".join(one.kind.choices)}" ;;')
    return (
        "_voxrt() {\n"
        '  local words="" current="${COMP_WORDS[COMP_CWORD]}" previous="${COMP_WORDS[COMP_CWORD-1]}"\n'
        "  COMPREPLY=()\n"
        '  if [ "$COMP_CWORD" -eq 1 ]; then\n'
        f'    COMPREPLY=($(compgen -W "{" ".join(COMMANDS)} --help --version" -- "$current"))\n'
        "    return\n"
        "  fi\n"
        '  case "${COMP_WORDS[1]}:$previous" in\n' + "\n".join(values) + "\n"
        '    *) case "${COMP_WORDS[1]}" in\n' + "\n".join(flags) + "\n"
        "    esac ;;\n"
        "  esac\n"
        '  COMPREPLY=($(compgen -W "$words" -- "$current"))\n'
        "}\n"
        "_voxrt_build() {\n"
        '  COMP_WORDS=(voxrt build "${COMP_WORDS[@]:1}")\n'
        "  COMP_CWORD=$((COMP_CWORD + 1))\n"
        "  _voxrt\n"
        "}\n"
        "complete -o default -F _voxrt voxrt\n"
        "complete -o default -F _voxrt_build voxrt-build\n"
    )


def _zsh() -> str:
    cases = []
    for command in COMMANDS:
        entries = []
        for name, one in _named(command).items():
            value = "" if one.kind.is_flag else f":{name}:" + _zsh_values(one)
            star = "*" if one.kind.many else ""
            entries += [f"'{star}{flag}[{_summary(one, command)}]{value}'" for flag in flags_of(name, one)]
        choices = _argument_choices(command)
        entries.append(f"'*:argument:({choices})'" if choices else "'*:file:_files'")
        cases.append(f"    {command}) _arguments {' '.join(entries)} ;;")
    commands = " ".join(f"'{name}:{command.purpose.replace(chr(39), '')}'" for name, command in COMMANDS.items())
    return (
        "#compdef voxrt voxrt-build\n"
        "_voxrt() {\n"
        '  if [[ $service == voxrt-build ]]; then words=(voxrt build "${(@)words[2,-1]}"); (( CURRENT++ )); fi\n'
        "  if (( CURRENT == 2 )); then\n"
        f"    local -a commands=({commands})\n"
        "    _describe command commands\n"
        "    return\n"
        "  fi\n"
        "  local command=$words[2]\n"
        "  shift words; (( CURRENT-- ))\n"
        "  case $command in\n" + "\n".join(cases) + "\n"
        "  esac\n"
        "}\n"
        "compdef _voxrt voxrt voxrt-build\n"
    )


def _zsh_values(option: Option) -> str:
    if option.kind.choices:
        return f"({' '.join(option.kind.choices)})"
    return "_files" if option.kind.is_file else " "


def _fish() -> str:
    lines = ["complete -c voxrt -n __fish_use_subcommand -f", "complete -c voxrt-build -w 'voxrt build'"]
    for command, about in COMMANDS.items():
        purpose = about.purpose.replace("'", "")
        lines.append(f"complete -c voxrt -n __fish_use_subcommand -a {command} -d '{purpose}'")
        within = f"complete -c voxrt -n '__fish_seen_subcommand_from {command}'"
        if choices := _argument_choices(command):
            lines.append(f"{within} -f -a '{choices}'")
        for name, one in _named(command).items():
            names = " ".join(f"-l {flag[2:]}" if flag[1] == "-" else f"-s {flag[1:]}" for flag in flags_of(name, one))
            needs = "" if one.kind.is_flag or one.kind.is_optional else " -r" if one.kind.is_file else " -x"
            values = f" -a '{' '.join(one.kind.choices)}'" if one.kind.choices else ""
            lines.append(f"{within} {names}{needs}{values} -d '{_summary(one, command)}'")
    return "\n".join(lines) + "\n"
