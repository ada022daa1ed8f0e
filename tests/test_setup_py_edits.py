"""Edits of setup.py and setup.cfg are valid Python and INI in the style of the file."""

from __future__ import annotations

import ast
from configparser import ConfigParser

import pytest

from ros_lint.analysis.finding import Fix
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, Text, file_start
from ros_lint.base.tree import MemoryTree
from ros_lint.collectors.setup_py import edits as setup_edits
from ros_lint.engine import edits
from ros_lint.facts.build import BuildScript
from ros_lint.facts.setup_py import EditableList
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.packages import manifest_text

END = Span("setup.py", 1, 1, 1, 1)
LIST = EditableList("data_files", END, comma=True, indent=None, size=1)


def script_of(setup: str, config: str | None = None) -> BuildScript:
    files = {"robot/package.xml": manifest_text("robot", build_type="ament_python"), "robot/setup.py": setup}
    files |= {} if config is None else {"robot/setup.cfg": config}
    (package,) = Loader(MemoryTree(files), ("",), TargetDistro("jazzy", "test")).load().packages
    assert package.script is not None
    return package.script


def apply(text: str, path: str, *changes: Edit) -> str:
    return edits.apply([Fix("", changes)], lambda _: Text(path, text))[path]


# --- elements of lists ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("comma", "indent", "text"),
    [(True, None, " 'x',"), (False, None, ", 'x'"), (True, "    ", "\n    'x',"), (False, "    ", ",\n    'x'")],
)
def test_an_element_continues_the_list_in_its_style(comma: bool, indent: str | None, text: str) -> None:
    assert setup_edits.add(LIST._replace(comma=comma, indent=indent), "'x'") == Edit(END, text)


@pytest.mark.parametrize(
    ("quote", "text", "expected"),
    [
        ("'", "a", "'a'"),
        ('"', "a", '"a"'),
        ('"', 'say "a"', "'say \"a\"'"),
        ("'", "it's", '"it\'s"'),
        ('"', "a\\b", "'a\\\\b'"),
        ('"', "a\nb", "'a\\nb'"),
        ('"', "", '""'),
    ],
)
def test_a_text_is_quoted_as_the_other_texts_of_the_list(quote: str, text: str, expected: str) -> None:
    quoted = setup_edits.quoted(LIST._replace(quote=quote), text)
    assert quoted == expected
    assert ast.literal_eval(quoted) == text


@pytest.mark.parametrize(
    ("joins", "variable", "before", "after", "expected"),
    [
        ("", "", "share/", "", "'share/robot'"),
        ("", "", "", "", "'robot'"),
        ("", "", "share/", "/launch", "'share/robot/launch'"),
        ("", "name", "share/", "", "'share/' + name"),
        ("", "name", "", "", "name"),
        ("", "name", "", "/launch", "name + '/launch'"),
        ("", "name", "share/", "/launch", "'share/' + name + '/launch'"),
        ("f", "", "share/", "/launch", "'share/robot/launch'"),
        ("f", "name", "share/", "/launch", "f'share/{name}/launch'"),
        ("f", "name", "share/", "", "f'share/{name}'"),
        ("os.path.join", "", "share/", "/a/b", "os.path.join('share', 'robot', 'a', 'b')"),
        ("join", "name", "share/", "", "join('share', name)"),
        ("join", "name", "share/", "/robots", "join('share', name, 'robots')"),
        ("join", "name", "", "/launch", "join(name, 'launch')"),
        ("join", "name", "", "", "name"),
        ("join", "", "", "", "'robot'"),
    ],
)
def test_a_folder_of_the_package_is_composed_as_the_other_folders(
    joins: str, variable: str, before: str, after: str, expected: str
) -> None:
    assert setup_edits.joined(LIST._replace(joins=joins, variable=variable), "robot", before, after) == expected


# --- files to install ----------------------------------------------------------------------------------------------

GLOB = LIST._replace(glob="glob")


@pytest.mark.parametrize(
    ("slot", "paths", "others", "expected"),
    [
        (LIST, ["launch/a.launch.py"], [], " ('share/robot/launch', ['launch/a.launch.py']),"),
        (LIST, ["b.yaml", "a.yaml"], [], " ('share/robot', ['a.yaml', 'b.yaml']),"),
        (LIST, ["b/x.yaml", "a/x.yaml"], [], " ('share/robot/a', ['a/x.yaml']), ('share/robot/b', ['b/x.yaml']),"),
        (
            LIST._replace(indent="    "),
            ["b/x.yaml", "a/x.yaml"],
            [],
            "\n    ('share/robot/a', ['a/x.yaml']),\n    ('share/robot/b', ['b/x.yaml']),",
        ),
        # all files of an ending
        (GLOB, ["launch/a.launch.py"], ["launch/b.py"], " ('share/robot/launch', glob('launch/*.launch.py')),"),
        (GLOB, ["launch/a.launch.py", "launch/b.launch.py"], [], " ('share/robot/launch', glob('launch/*.launch.py')),"),
        (GLOB, ["launch/a.py", "launch/b.launch.py"], ["launch/sub/c.py"], " ('share/robot/launch', glob('launch/*.py')),"),
        (GLOB, ["launch/a_x.py", "launch/b_x.py"], [], " ('share/robot/launch', glob('launch/*.py')),"),
        # further files have the ending
        (GLOB, ["launch/a.launch.py"], ["launch/b.launch.py"], " ('share/robot/launch', ['launch/a.launch.py']),"),
        # all files of a folder
        (GLOB, ["maps/a.pgm", "maps/a.yaml"], ["maps2/x"], " ('share/robot/maps', glob('maps/*')),"),
        (GLOB, ["maps/LICENSE"], [], " ('share/robot/maps', glob('maps/*')),"),
        (GLOB, ["maps/a.pgm", "maps/a.yaml"], ["maps/b"], " ('share/robot/maps', ['maps/a.pgm', 'maps/a.yaml']),"),
        (GLOB, ["maps/a.pgm", "maps/a.yaml"], ["maps/sub/b"], " ('share/robot/maps', ['maps/a.pgm', 'maps/a.yaml']),"),
        # the folder of setup.py
        (GLOB, ["a.yaml"], [], " ('share/robot', ['a.yaml']),"),
        # a glob does not match hidden files
        (GLOB, ["maps/.a.yaml"], [], " ('share/robot/maps', ['maps/.a.yaml']),"),
        (GLOB, ["maps/a.pgm", "maps/a.yaml"], ["maps/.gitkeep"], " ('share/robot/maps', glob('maps/*')),"),
    ],
)
def test_files_are_installed_by_a_glob_if_it_matches_only_them(
    slot: EditableList, paths: list[str], others: list[str], expected: str
) -> None:
    assert setup_edits.add_files(slot, "robot", paths, [*paths, *others]) == Edit(END, expected)


# --- places --------------------------------------------------------------------------------------------------------

SETUP = "from setuptools import setup\nsetup(\n    name='robot',\n    packages=[],\n    data_files=[('a', ['b'])],\n)\n"


def test_only_a_list_with_elements_has_a_slot() -> None:
    script = script_of(SETUP)
    slot = setup_edits.slot(script, "data_files")
    assert slot is not None
    assert (slot.option, slot.size) == ("data_files", 1)
    assert setup_edits.slot(script, "packages") is None
    assert setup_edits.slot(script, "scripts") is None


@pytest.mark.parametrize(
    ("setup", "line"), [(SETUP, 5), (SETUP.replace("data_files", "x"), 3), ("from setuptools import setup\nsetup()\n", 1)]
)
def test_install_rules_belong_to_data_files_else_to_the_name(setup: str, line: int) -> None:
    assert setup_edits.place(script_of(setup)).line == line


# --- setup.cfg -----------------------------------------------------------------------------------------------------

WANTED = {"develop.script_dir": "$base/lib/robot", "install.install_scripts": "$base/lib/robot"}


def options(text: str) -> dict[str, str]:
    parser = ConfigParser(interpolation=None)
    parser.read_string(text)
    return {f"{section}.{option}": value for section in parser.sections() for option, value in parser[section].items()}


def test_a_new_configuration_installs_programs_to_the_folder_of_the_package() -> None:
    edit = setup_edits.config(file_start("robot/setup.cfg"), "robot")
    assert edit.span == file_start("robot/setup.cfg")
    assert edit.text == "[develop]\nscript_dir=$base/lib/robot\n[install]\ninstall_scripts=$base/lib/robot\n"
    assert options(edit.text) == WANTED


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (
            "[develop]\nscript_dir=$base/bin\n[install]\ninstall_scripts = $base/bin\n",
            "[develop]\nscript_dir=$base/lib/robot\n[install]\ninstall_scripts = $base/lib/robot\n",
        ),
        (
            "[develop]\nuser=1\n\n[install]\n",
            "[develop]\nscript_dir=$base/lib/robot\nuser=1\n\n[install]\ninstall_scripts=$base/lib/robot\n",
        ),
        (
            "[metadata]\nname=robot\n",
            "[metadata]\nname=robot\n[develop]\nscript_dir=$base/lib/robot\n[install]\ninstall_scripts=$base/lib/robot\n",
        ),
        (
            "[install]\ninstall_scripts=x\n[develop]",
            "[install]\ninstall_scripts=$base/lib/robot\n[develop]\nscript_dir=$base/lib/robot",
        ),
        ("[develop]", "[develop]\nscript_dir=$base/lib/robot\n[install]\ninstall_scripts=$base/lib/robot"),
        ("[install]", "[install]\ninstall_scripts=$base/lib/robot\n[develop]\nscript_dir=$base/lib/robot"),
    ],
)
def test_an_existing_configuration_keeps_its_other_options(before: str, after: str) -> None:
    text = apply(before, "robot/setup.cfg", *setup_edits.programs_to(script_of(SETUP, before), "robot"))
    assert text == after
    assert options(before).items() - WANTED.items() >= {item for item in options(text).items() if item[0] not in WANTED}
    assert WANTED.items() <= options(text).items()


def test_without_a_configuration_there_is_nothing_to_edit() -> None:
    script = script_of(SETUP)
    assert setup_edits.programs_to(script, "robot") == ()
    assert setup_edits.program_folders(script) == {}


def test_the_options_with_the_folder_of_programs_are_found() -> None:
    text = "[develop]\nscript_dir=a\nuser=1\n[install]\ninstall_scripts=bc\n[metadata]\nscript_dir=d\n"
    found = setup_edits.program_folders(script_of(SETUP, text))
    assert {name: Text("", text).slice(span) for name, span in found.items()} == {
        "develop.script_dir": "a",
        "install.install_scripts": "bc",
    }
