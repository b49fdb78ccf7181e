"""What is made of the tables of options is what they say."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from msgspec import NODEFAULT

from voxrt.cli.line.command_line import command_options, flags_of, read_options
from voxrt.cli.line.completion_script import completion_script
from voxrt.cli.line.help_text import command_help, label, option_text, task_help
from voxrt.options.build_options import BuildOptions
from voxrt.options.commands import COMMANDS
from voxrt.options.option import options_of
from voxrt.options.picture_commands import TraceCommand
from voxrt.options.render_options import RenderOptions
from voxrt.options.tasks import TASKS

README = Path(__file__).resolve().parents[2] / "README.md"

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
    if option.default in (NODEFAULT, None, ()) or option.kind.is_flag or option.kind.is_optional:
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
        (["voxrt-build", "a.obj", "--fill", "s"], {"solid", "surface"}),
        (["voxrt-build", "--dep"], {"--depth"}),
    ],
)
def test_bash_completes(words, candidates):
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("bash is not installed")
    quoted = " ".join(f"'{word}'" for word in words)
    function = f"_{words[0].replace('-', '_')}"
    code = f"COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; {function}; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    script = completion_script("bash") + code
    done = subprocess.run([bash], input=script, capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == candidates


def test_the_manual_page_describes_every_option():
    import make_man_page

    if shutil.which("man") is None:
        pytest.skip("man is not installed")
    shown = subprocess.run(
        ["man", "--warnings", "-l", "-"],
        input=make_man_page.man_page(),
        env={"MANWIDTH": "200", "MAN_KEEP_FORMATTING": "", "PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert shown.stderr == ""
    text = " ".join(shown.stdout.split())
    for command in COMMANDS:
        options = command_options(command)
        for name, option in options.items():
            assert f"{label(name, option)} {option_text(option, options)}" in text, (command, name)


@pytest.mark.parametrize("task", TASKS)
def test_the_command_lines_of_a_task_are_in_the_readme_and_can_be_read(task):
    readme = [line.split("  #")[0].strip() for line in README.read_text(encoding="utf-8").splitlines()]
    shown = task_help(task)
    for line, comment in TASKS[task].lines:
        assert f"{line} " in shown
        assert f"# {comment}\n" in shown
        assert line in readme
        command, *words = line.replace("voxrt-build", "voxrt build").split()[1:]
        read_options(command, words)


def test_a_table_needs_what_has_no_default():
    with pytest.raises(TypeError, match="TraceCommand needs scene"):
        TraceCommand(pixel=(1, 2))
