"""Inputs that once crashed ros-lint, or kept it busy for minutes, end in 5 s and 300 MB.

Each is the smallest form of a failure that was found by hand or by fuzzing. All are examined in one child process.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pytest

from ros_lint import knowledge
from ros_lint.cli.main import main
from tests.fuzz import server
from tests.fuzz.hostile import _cmake, _launch, _manifest, _setup
from tests.fuzz.oracle import Measured, Plan
from tests.fuzz.seeds import write
from tests.fuzz.targets import _PACKAGE, _PYTHON

pytestmark = pytest.mark.slow


def _script(text: str) -> dict[str, str]:
    return {"q/CMakeLists.txt": text}


def _program(body: str) -> dict[str, str]:
    return {"q/launch/a.launch.py": _launch(body)}


def _xml(body: str) -> dict[str, str]:
    return {"q/launch/a.launch.xml": f"<launch>{body}</launch>"}


def _lines(count: int, line: str) -> str:
    return "".join(line.replace("%d", str(number)).replace("%e", str(number + 1)) + "\n" for number in range(count))


_DOUBLED: Final = "a0: &a0 [x]\n" + "".join(f"a{n + 1}: &a{n + 1} [*a{n}, *a{n}]\n" for n in range(30))
_TWICE: Final = "x = [1]\ny = [1]\n" + "x = [x, x]\ny = [y, y]\n" * 30

INPUTS: Final = {
    "a text that is not closed after blanks": _script("install(FILES a\n" + " " * 26 + '"b.txt\n DESTINATION x)'),
    "a banner before a token error": _script("#" * 78 + "\n# Subdirectories\n" + "#" * 78 + '\n\n"(BUILD_TESTING)\n'),
    "setup.py: brackets": {"r/setup.py": "x=" + "[" * 1_500 + "]" * 1_500},
    "setup.py: attributes": {"r/setup.py": "x = a" + ".b" * 10_000},
    "setup.py: alternatives of a sum": {"r/setup.py": _setup("while True:\n    x = x + x if 'x' in globals() else 'a'")},
    "setup.py: elif": {"r/setup.py": "if a: pass\n" + "elif b: pass\n" * 3_000},
    "colcon.pkg: dashes": {"q/colcon.pkg": "- " * 25_000},
    "colcon.meta: dashes": {"colcon.meta": "- " * 25_000},
    "launch YAML: dashes": {"q/launch/a.launch.yaml": "launch:\n- " + "- " * 30_000},
    "launch XML: a value of brackets": _xml(f'<node pkg="q" exec="n"><param name="p" value="{"[" * 25_000}"/></node>'),
    "a parameter file of dashes that a launch file opens": {
        **_program("x = yaml.safe_load(open(os.path.join(os.path.dirname(__file__), 'p.yaml')))"),
        "q/launch/p.yaml": "- " * 30_000,
    },
    "colcon.pkg with another name": {"q/colcon.pkg": '{"name": "renamed"}'},
    "a literal for yaml.safe_load": _program("x = yaml.safe_load('{rate: 10}')"),
    "patterns that are no expressions": {".gitignore": "[z-a]\n[a-\\\\]\n[--0]\n[&&a]\n[~~]\n", "q/config/a": ""},
    "stars in .gitignore": {".gitignore": "*a" * 8 + "b\n" + "**/" * 12 + "b\n", "q/config/" + "a" * 200: ""},
    "blanks in .gitignore": {".gitignore": " " * 30_000 + "a", "q/config/a": ""},
    "CMake: numbers of many digits": _script(
        _cmake(f"math(EXPR a \"{'9' * 5_000} + 1\")\nif({'9' * 5_000} VERSION_LESS 1)\nendif()\nfile(GLOB b [z-a])")
    ),
    "cmake_minimum_required of many digits": _script(f"cmake_minimum_required(VERSION {'9' * 5_000})\nproject(q)\n"),
    "version_gte of many digits": {"q/package.xml": _manifest(f"  <depend version_gte=\"{'9' * 5_000}\">rclcpp</depend>\n")},
    "launch YAML that holds itself": {"q/launch/a.launch.yaml": "launch:\n- let: {name: a, value: &v [*v]}\n"},
    "a baseline of 1e999": {"known.json": '{"known": 1e999}', "ros-lint.toml": 'baseline = "known.json"\n'},
    "jobs of many digits": {"ros-lint.toml": f"jobs = {'9' * 5_000}\n"},
    "jobs of 10**18": {"ros-lint.toml": f"jobs = {10**18}\n"},
    "many jobs": {"ros-lint.toml": "jobs = 2000\n"},
    "settings of brackets": {"ros-lint.toml": "select = " + "[" * 100_000},
    "tool = 1": {"pyproject.toml": "tool = 1\n"},
    "pyproject.toml of empty lines": {"pyproject.toml": "\n" * 100_000},
    "CMake: a macro that doubles": _script(_cmake('macro(m x)\n  m("${x}${x}")\nendmacro()\nm(a)')),
    "CMake: stars in an expression": _script(_cmake(f"if(\"{'x' * 400}\" MATCHES \"x*x*x*x*y\")\nendif()")),
    "CMake: alternatives in an expression": _script(_cmake(f"if(\"{'a' * 32}\" MATCHES \"(a|aa)+b\")\nendif()")),
    "CMake: stars in file(GLOB)": {
        **_script(_cmake("file(GLOB a " + "*a" * 8 + "b)")), **{f"q/{'a' * (60 + n)}": "" for n in range(5)},
    },
    "CMake: a text that grows in a loop": _script(_cmake('foreach(i RANGE 20000)\n  set(x "${x}' + "a" * 50 + '")\nendforeach()')),
    "CMake: targets in a chain": _script(
        _cmake(_lines(1_000, "add_library(a%d x.cpp)\ntarget_link_libraries(a%d a%e)"))
    ),
    "CMake: targets in a ring": _script(
        _cmake(_lines(1_500, "add_library(a%d x.cpp)\ntarget_link_libraries(a%d a%e)") + "target_link_libraries(a1499 a0)")
    ),
    "CMake: nested conditions": _script(_cmake("if(A)\n" * 20_000 + "message(a)\n" * 20_000 + "endif()\n" * 20_000)),
    "CMake: missing files": _script(_cmake("install(FILES " + " ".join(f"a{n}" for n in range(10_000)) + " DESTINATION x)")),
    "CMake: unknown packages": _script(_cmake(_lines(5_000, "find_package(b%d)"))),
    "CMake: ament_auto_package in loops": _script(
        _cmake("find_package(ament_cmake_auto)\n" + "foreach(a 1 2 3 4 5 6 7 8)\n" * 8 + "ament_auto_package()\n" + "endforeach()\n" * 8)
    ),
    "a file name of an old version": {"q/launch/a_old" + "1" * 26 + ".launch.py": ""},
    "setup.py: lists that are compared": {"r/setup.py": _setup(f"{_TWICE}z = x == y")},
    "setup.py: a key of tuples": {"r/setup.py": _setup("x = (1,)\n" + "x = (x, x)\n" * 30 + "y = {x: 1}")},
    "setup.py: double stars": {
        "r/setup.py": _setup("x = glob('**/a/' * 30 + '**', recursive=True)\ny = glob('**/' * 500 + '*', recursive=True)"),
        "r/" + "a/" * 40 + "b.py": "",
    },
    "setup.py: entry points": {
        "r/setup.py": _setup("").replace(
            "packages=['r']", "entry_points={'console_scripts': [" + ", ".join(f"'a{n} = r.n:main'" for n in range(5_000)) + "]}"
        )
    },
    "launch.py: doubling in loops": _program("y = 'a'\nfor a in u():\n    for b in range(99):\n        for c in range(99):\n            y = y + y"),
    "launch.py: what an unknown call gets": _program("y = list(range(1000))\nfor a in range(200):\n    for b in range(200):\n        u(y)"),
    "launch.yaml: anchors": {"q/launch/a.launch.yaml": f"{_DOUBLED}launch:\n- arg: {{name: a, default: *a30}}\n"},
    "launch.xml: chained arguments": _xml(_lines(10_000, '<arg name="a%d" default="$(var a%e)"/>')),
    "launch.xml: missing includes": _xml(_lines(5_000, '<include file="$(find-pkg-share q)/launch/b%d.launch.xml"/>')),
    "package.xml: unknown depends": {"q/package.xml": _manifest(_lines(2_000, "  <depend>b%d</depend>"))},
    "package.xml: the same depends": {"q/package.xml": _manifest("  <depend>rclcpp</depend>\n" * 5_000)},
    "package.xml: attributes": {"q/package.xml": _manifest(f"  <depend {' '.join(f'a{n}=' + chr(39) * 2 for n in range(5_000))}>b</depend>\n")},
    "package.xml: groups": {"q/package.xml": _manifest(_lines(5_000, "  <member_of_group>b%d</member_of_group>"))},
    "C++: includes in one line": {"q/src/n.cpp": "#include <" * 20_000},
    "C++: look-ups": {"q/src/n.cpp": "auto x = " + " + ".join(f'get_package_share_directory("a{n}")' for n in range(2_000)) + ";"},
    "C++: one look-up many times": {"q/src/n.cpp": "auto x = " + 'get_package_share_directory("a") + ' * 10_000},
    "C++: suppressions": {"q/src/n.cpp": "// ros-lint: ignore[x]\n" * 2_000},
    "services: parts": {"q/srv/A.srv": "---\n" * 20_000},
    "Python: punycode": {"r/r/n.py": "# coding: punycode\n" + "a" * 400_000},
    "CMake without a manifest": {"n/CMakeLists.txt": "find_package(Q" + " " * 200_000},
    "parameters: blanks": {"q/config/a.yaml": "  .1" + " " * 200_000},
    "findings in one long line": {"q/src/n.cpp": " ".join(f"/* */ auto a{n} = \"/home/b/c{n}\";" for n in range(1_000))},
}  # fmt: skip
"""Files by the failure, over two packages without one."""


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Measured]]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(knowledge, "_DataFiles", knowledge._DataFiles)  # restored in the end
        server.warm_up()
        yield examine(tmp_path_factory.mktemp("hardness"), patch)


def examine(folder: Path, patch: pytest.MonkeyPatch) -> dict[str, Measured]:
    """Return what each input does."""
    answers: list[Measured] = []
    patch.setattr(server, "_answer", lambda fields: answers.append(Measured(*fields)))
    for number, files in enumerate(INPUTS.values()):
        contents = {path: text.encode() for path, text in {**_PACKAGE, **_PYTHON, **files}.items()}
        (folder / str(number)).mkdir()
        write(contents, str(folder / str(number)))
    folders, plans = [str(folder / str(number)) for number in range(len(INPUTS))], [Plan()] * len(INPUTS)
    while folders:
        done = server._serve_batch(main, folders, plans)
        folders, plans = folders[done:], plans[done:]
    return dict(zip(INPUTS, answers, strict=True))


@pytest.mark.parametrize("name", INPUTS)
def test_an_input_ends_in_time(measured: dict[str, Measured], name: str) -> None:
    assert measured[name].failure == ""
    assert measured[name].runs == 1
