"""What the evaluation of setup.py rests on: the files as glob, os.walk and setuptools see them, and setup.cfg."""

from __future__ import annotations

import glob
import os
import random
from configparser import Error, RawConfigParser
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from setuptools import find_namespace_packages, find_packages

from ros_lint.base.text import Text
from ros_lint.collectors.setup_py import setup_cfg
from ros_lint.collectors.setup_py.interpreter.files import ROOT, Files

NAMES = ["a", "b", ".h", "ab", "c.py", "a.b", "__init__.py"]
PARTS = ["*", "**", "a*", "?", ".*", "[ab]", "[!a]*", "a", "b", "", "*.py", ".h", "ab", "**"]


def make(base: Path, dice: random.Random) -> list[str]:
    """Make some files, and no empty folder: version control has none."""
    made = []
    for _ in range(dice.randint(0, 14)):
        path = base.joinpath(*(dice.choice(NAMES) for _ in range(dice.randint(1, 4))))
        if not path.exists() and not any(parent.is_file() for parent in path.parents):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
            made.append(path.relative_to(base).as_posix())
    return sorted(made)


@pytest.mark.parametrize("seed", range(40))
def test_files_are_found_as_on_a_disk(seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    dice = random.Random(seed)
    files = Files(make(tmp_path, dice))
    monkeypatch.chdir(tmp_path)
    for _ in range(40):
        pattern = "/".join(dice.choice(PARTS) for _ in range(dice.randint(1, 4))).lstrip("/")
        pattern = dice.choice(["", "", "", "./"]) + pattern
        # Versions of CPython differ about folders in "x/**" where x is a file, and about "a/**/**".
        for recursive in [False] if "**/**" in pattern else [False, True]:
            # glob.glob() returns a path several times if several ** match it in several ways.
            expected = sorted({path for path in glob.glob(pattern, recursive=recursive) if path[-1] != "/"})
            found = files.glob(pattern, recursive=recursive)
            assert [path for path in found if path[-1] != "/"] == expected, pattern
    for top in [".", "a", "a/b", "./a", "nope", "a/c.py"]:
        expected_walk = sorted((root, sorted(folders), sorted(names)) for root, folders, names in os.walk(top))
        assert sorted((root, sorted(folders), sorted(names)) for root, folders, names in files.walk(top)) == expected_walk
    for path in ["a", "a/", "a/b", "c.py", "./b", "nope", "."]:
        assert files.is_file(path) == Path(path).is_file() or path.endswith("/")
        assert files.is_folder(path) == Path(path).is_dir()
    for exclude in [(), ("a",), ("a", "a.*", "*.b")]:
        assert sorted(files.find(".", namespaces=False, exclude=exclude)) == sorted(find_packages(".", exclude))
        assert sorted(files.find(".", namespaces=True, exclude=exclude)) == sorted(find_namespace_packages(".", exclude))


def test_places_inside_and_outside() -> None:
    files = Files(["a/b"])
    assert [files.inside(path) for path in ("a/b", f"{ROOT}/a/../c", ROOT, "../x", "/etc", "./a/")] == [
        "a/b",
        "c",
        "",
        None,
        None,
        "a",
    ]


LINES = st.sampled_from(
    [
        "[options]",
        "[options.entry_points]",
        " [indented]",
        "key = value",
        "key: value = x",
        "Key=",
        "  continued = more",
        "\tcontinued",
        "# comment",
        "  ; comment",
        "",
        "   ",
        "with-dash = 1",
        "no option",
        "spaces in key = x  ",
        "=x",
    ]
)


@given(st.lists(LINES, max_size=10), st.sampled_from(["\n", "\r\n"]))
@settings(max_examples=1000)
def test_setup_cfg_is_read_as_by_configparser(lines: list[str], newline: str) -> None:
    source = Text("setup.cfg", newline.join(lines))
    found = setup_cfg.collect(source)
    parser = RawConfigParser(strict=False)
    parser.optionxform = str  # type: ignore[assignment, method-assign]
    try:
        parser.read_string("\n".join(lines))
    except Error:
        assert any(problem.kind == "setup-cfg-syntax" for problem in found.problems)
        return
    assert all(problem.kind == "dashed-key" for problem in found.problems)
    expected = {
        (section, key.replace("-", "_")): [line for line in value.split("\n") if line]
        for section in parser.sections()
        for key, value in parser[section].items()
    }
    assert {(option.section, option.key): [line.text for line in option.lines] for option in found.options} == expected
    for option in found.options:
        assert source.slice(option.span).replace("-", "_") == option.key
        assert [source.slice(line.span) for line in option.lines] == [line.text for line in option.lines]


def test_only_the_first_wrong_lines_of_setup_cfg_are_reported() -> None:
    text = "[options]\n" + "wrong\n" * 12
    found = setup_cfg.collect(Text("setup.cfg", text)).problems
    assert [problem.span.line for problem in found] == list(range(2, 12))


def test_lines_that_continue_an_option_belong_to_it() -> None:
    text = "[options]\ninstall_requires =\n  a\n  b\n\n  c\npackages = d\n  e\n[metadata]\n"
    options = setup_cfg.collect(Text("setup.cfg", text)).section("options")
    assert options["install_requires"].value == "a\nb\nc"
    assert options["packages"].value == "d\ne"
