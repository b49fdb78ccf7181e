"""What is made of the tables of options is what they say."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import MISSING

import pytest

from voxrt.cli.line.command_line import command_options, flags_of
from voxrt.cli.line.completion_script import completion_script
from voxrt.cli.line.help_text import command_help
from voxrt.options.build_options import BuildOptions
from voxrt.options.commands import COMMANDS
from voxrt.options.option import options_of
from voxrt.options.render_options import RenderOptions

OPTIONS = [
    pytest.param(command, name, option, id=f"{command} {name}")
    for command in COMMANDS
    for name, option in command_options(command).items()
]


def test_the_keywords_are_those_of_the_tables():
    import make_options

    assert make_options.KEYWORDS.read_text() == make_options.keywords(), "run python docs/make_options.py"


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_is_in_the_help_the_completion_and_the_manual(command):
    import make_options

    options = command_options(command)
    flags = [flag for name, option in options.items() for flag in flags_of(name, option)]
    for text in (command_help(command, full=True), make_options.page()):
        assert all(flag in text for flag in flags)
    short = command_help(command, full=False)
    assert all(flags_of(name, option)[0] in short for name, option in options.items())
    for shell in ("bash", "zsh", "fish"):
        script = completion_script(shell)
        assert all(flag.lstrip("-") in script for flag in flags if flag.startswith("--"))


def test_the_help_of_build_has_groups_on_one_screen(monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    lines = command_help("build", full=False).splitlines()
    assert 24 <= len(lines) <= 50
    assert {"Grid", "What is voxelized", "Colours and light", "Memory", "Preview", "Running"} <= set(lines)


@pytest.mark.parametrize(("_command", "name", "option"), OPTIONS)
def test_a_default_can_be_written_and_read(_command, name, option):
    if option.default in (MISSING, None, ()) or option.kind.is_flag or option.kind.is_optional:
        return
    text = option.kind.write(option.default)
    assert option.kind.check(name, option.kind.read(text)) == option.default


@pytest.mark.parametrize("table", [BuildOptions, RenderOptions])
def test_the_docstring_describes_every_option(table):
    for name, option in options_of(table).items():
        assert f"\n    {name}\n        {option.help.split('{')[0]}" in table.__doc__


@pytest.mark.parametrize(
    ("words", "candidates"),
    [
        (["voxrt", "bu"], {"build"}),
        (["voxrt", "build", "a.obj", "--fill", "s"], {"solid", "surface"}),
        (["voxrt", "render", "--lod-"], {"--lod-cell"}),
        (["voxrt", "completion", ""], {"--help", "-h", "bash", "zsh", "fish"}),
    ],
)
def test_bash_completes(words, candidates):
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("bash is not installed")
    quoted = " ".join(f"'{word}'" for word in words)
    code = f"COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; _voxrt; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    script = completion_script("bash") + code
    done = subprocess.run([bash], input=script, capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == candidates
