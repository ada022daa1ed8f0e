"""Invalid workspaces give a message with the place, and other packages are still checked."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

pytestmark = pytest.mark.slow

GOOD = """<?xml version="1.0"?>
<package format="3">
  <name>{0}</name>
  <version>1.0.0</version>
  <description>Good.</description>
  <maintainer email="ada@robots.example">Ada</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.16)
project({0})
find_package(ament_cmake REQUIRED)
find_package(sensor_msgs REQUIRED)
ament_package()
"""


class Ran(NamedTuple):
    code: int
    out: dict[str, Any]
    err: str
    text: str


def lint(*arguments: str | os.PathLike[str], cwd: Path | None = None, text: bool = False) -> Ran:
    command = [sys.executable, "-m", "ros_lint", *map(str, arguments), "--no-cache", "--distro", "jazzy"]
    form = [] if text else ["--format", "json"]
    process = subprocess.run([*command, *form], capture_output=True, cwd=cwd, timeout=60, check=False)
    assert b"Traceback" not in process.stderr, process.stderr.decode()
    out = json.loads(process.stdout) if process.stdout.startswith(b"{") else {}
    return Ran(process.returncode, out, process.stderr.decode(), process.stdout.decode())


def package(folder: Path, name: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(GOOD.format(name))
    (folder / "CMakeLists.txt").write_text(CMAKE.format(name))
    return folder


def rules(ran: Ran, path: str) -> list[str]:
    return [finding["rule"] for finding in ran.out["findings"] if finding["path"].startswith(path)]


def test_an_empty_folder_gives_exit_code_2(tmp_path: Path) -> None:
    for form in (True, False):
        ran = lint(tmp_path, text=form)
        assert ran.code == 2
        assert "no package found" in ran.err
        assert form or ran.out["packages"] == 0


def test_a_folder_that_colcon_skips_is_named(tmp_path: Path) -> None:
    package(tmp_path / "ws" / "src", "robot")
    (tmp_path / "COLCON_IGNORE").write_text("")
    ran = lint(tmp_path)
    assert ran.code == 2
    assert f"below {tmp_path}; skipped: . (COLCON_IGNORE); to check a skipped folder" in ran.err
    assert lint(tmp_path / "ws").out["packages"] == 1


def test_skipped_folders_below_are_named(tmp_path: Path) -> None:
    for name in ("arm", "base", "camera", "lidar"):
        package(tmp_path / "src" / name, name)
        (tmp_path / "src" / name / "COLCON_IGNORE").write_text("")
    ran = lint(tmp_path)
    assert ran.code == 2
    named = ", ".join(f"src/{name} (COLCON_IGNORE)" for name in ("arm", "base", "camera"))
    assert f"skipped: {named} and 1 more; to check a skipped folder" in ran.err


def test_a_missing_path_is_an_error(tmp_path: Path) -> None:
    ran = lint(tmp_path / "nowhere")
    assert ran.code == 2
    assert f"{tmp_path}/nowhere: no such file or directory" in ran.err


def test_a_file_instead_of_a_folder_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "f").write_text("")
    ran = lint(tmp_path / "f")
    assert ran.code == 2
    assert "f: not a directory" in ran.err


def manifest_bytes(content: bytes) -> Callable[[Path], None]:
    def make(folder: Path) -> None:
        (folder / "package.xml").write_bytes(content)

    return make


BOMB = (
    b'<!DOCTYPE p [<!ENTITY a "aaaaaaaaaa">'
    + b"".join(b'<!ENTITY %c "%s">' % (98 + n, b"&%c;" % (97 + n) * 10) for n in range(9))
    + b"]>\n<package><name>&j;</name></package>"
)
EXTERNAL = b'<!DOCTYPE p [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<package format="3"><name>&x;</name></package>'
MANIFESTS = {
    "binary garbage": (bytes(range(256)) * 8, 1),
    "empty": (b"", 1),
    "entity bomb": (BOMB, 1),
    "external entity": (EXTERNAL, 1),
    "deep nesting": (b"<package><description>" + b"<a>" * 100_000 + b"</a>" * 100_000 + b"</description></package>", 1),
    "not UTF-8": (GOOD.format("bad").replace("Ada", "\xc4da").encode("latin-1"), 6),
    "merge conflict": (GOOD.format("bad").replace("  <version>", "<<<<<<< HEAD\n  <version>").encode(), 4),
    "10 MB": (GOOD.format("bad").replace("Good.", "Good. " * 1_800_000).encode(), None),
}


@pytest.mark.parametrize("case", MANIFESTS)
def test_an_invalid_manifest_is_reported_with_its_place(tmp_path: Path, case: str) -> None:
    content, line = MANIFESTS[case]
    package(tmp_path / "good", "good")
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "package.xml").write_bytes(content)
    ran = lint(tmp_path)
    assert rules(ran, "good/") == ["undeclared-dependency"]
    assert ran.code == 1
    result = [finding for finding in ran.out["findings"] if finding["path"] == "bad/package.xml"]
    if line is None:
        assert "rejected-manifest" not in [finding["rule"] for finding in result]
    else:
        assert [finding["line"] for finding in result if finding["rule"] == "rejected-manifest"][:1] == [line]
    assert "root:" not in ran.text


def test_a_folder_named_package_xml_is_no_package(tmp_path: Path) -> None:
    package(tmp_path / "good", "good")
    (tmp_path / "bad" / "package.xml").mkdir(parents=True)
    ran = lint(tmp_path)
    assert rules(ran, "good/") == ["undeclared-dependency"]
    assert ran.code == 1


def test_unreadable_files_are_listed_as_not_checked(tmp_path: Path) -> None:
    """Root reads everything, so a link to itself stands for a file without permission; it takes the same way."""
    good = package(tmp_path / "good", "good")
    (good / "src").mkdir()
    (good / "src" / "a.cpp").write_bytes(b"\0" * 100)
    if os.geteuid():
        (good / "src" / "b.cpp").write_text("")
        (good / "src" / "b.cpp").chmod(0)
    ran = lint(tmp_path)
    assert rules(ran, "good/") == ["undeclared-dependency"]
    assert "good/src/a.cpp" in [entry["what"] for entry in ran.out["not_checked"]]
    assert "good/src/a.cpp" in lint(tmp_path, text=True).text


def script_package(folder: Path) -> Path:
    """Write a package of Python whose program lands in bin/, unless a setup.cfg says otherwise."""
    (folder / "resource").mkdir(parents=True)
    (folder / "resource" / "talker").write_text("")
    (folder / "talker").mkdir()
    (folder / "talker" / "__init__.py").write_text("")
    (folder / "talker" / "node.py").write_text(
        "import rclpy\nfrom rclpy.node import Node\n\n\ndef main():\n    rclpy.spin(Node('talker'))\n"
    )
    manifest = GOOD.format("talker").replace("<buildtool_depend>ament_cmake</buildtool_depend>", "<depend>rclpy</depend>")
    (folder / "package.xml").write_text(manifest.replace("ament_cmake", "ament_python"))
    (folder / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(name='talker', version='1.0.0', packages=['talker'],\n"
        "      data_files=[('share/ament_index/resource_index/packages', ['resource/talker']),\n"
        "                  ('share/talker', ['package.xml'])],\n"
        "      entry_points={'console_scripts': ['node = talker.node:main']})\n"
    )
    return folder


def test_names_that_are_not_utf_8_are_escaped(tmp_path: Path) -> None:
    folder = package(tmp_path / "talker", "talker")
    (folder / "README.md").write_text("ros2 run talker talker")
    for inner in ("config", "scripts", "launch", "msg", "src", "talker", "maps"):
        for name in (b"%s.py", b"%s.launch.py", b"%s.yaml", b"%s.msg", b"%s/hall.yaml", b"%s/in/it.yaml"):
            file = os.path.join(os.fsencode(folder / inner), name % b"Caf\xe9")
            os.makedirs(os.path.dirname(file), exist_ok=True)
            with open(file, "w") as stream:
                stream.write(
                    "#!/usr/bin/env python3\nname = '/home/ada/talker/maps/hall.yaml', 'in/it.yaml'\n"
                    "if __name__ == '__main__':\n  pass\n"
                )
    for script in (None, "from setuptools import setup\nsetup(name='talker', version='1.0.0', packages=[])\n"):
        if script:
            (folder / "setup.py").write_text(script)
            (folder / "package.xml").write_text(GOOD.format("talker").replace("ament_cmake</build", "ament_python</build"))
        ran = lint("--pedantic", tmp_path)
        assert (ran.code, ran.out["crashes"]) == (1, [])
        assert "failed on it" not in ran.text
        assert any("Caf" in finding["path"] for finding in ran.out["findings"])


@pytest.mark.parametrize("what", ["a folder", "a link to its folder"])
def test_a_fix_does_not_replace_a_folder_by_a_file(tmp_path: Path, what: str) -> None:
    place = script_package(tmp_path / "talker") / "setup.cfg"
    if what == "a folder":
        place.mkdir()
    else:
        place.symlink_to(".")
    package(tmp_path / "good", "good")
    ran = lint(tmp_path, "--fix")
    assert "talker/setup.cfg: cannot be read: Is a directory" in ran.err
    assert rules(ran, "talker/") == ["entry-point-location"]
    assert rules(ran, "good/") == []  # fixed although another file failed


def test_an_unreadable_settings_file_is_an_error(tmp_path: Path) -> None:
    place = script_package(tmp_path / "talker") / "setup.cfg"
    place.write_bytes(b"\0" * 100)
    ran = lint(tmp_path)
    assert [entry["what"] for entry in ran.out["not_checked"]] == ["talker/setup.cfg"]


def test_link_loops_end(tmp_path: Path) -> None:
    good = package(tmp_path / "good", "good")
    (good / "up").symlink_to(tmp_path)
    (good / "self").symlink_to("self")
    (tmp_path / "again").symlink_to(good)
    ran = lint(tmp_path)
    assert ran.out["packages"] == 1
    assert ran.code == 1


def test_a_path_with_spaces_and_umlauts_is_checked(tmp_path: Path) -> None:
    folder = package(tmp_path / "mein Röböter 漢" / "src a", "good")
    ran = lint(tmp_path)
    assert rules(ran, "mein Röböter 漢/src a/") == ["undeclared-dependency"]
    assert lint(tmp_path, "--fix").code == 0
    assert "<depend>sensor_msgs</depend>" in (folder / "package.xml").read_text()


@pytest.mark.parametrize("what", ["file", "folder"])
def test_a_read_only_tree_is_checked(tmp_path: Path, what: str) -> None:
    good = package(tmp_path / "good", "good")
    before = (good / "package.xml").read_bytes()
    place = good / "package.xml" if what == "file" else good
    place.chmod(0o444 if what == "file" else 0o555)
    try:
        ran = lint(tmp_path, "--fix")
    finally:
        place.chmod(0o755)
    assert ran.code == 2
    assert "good/package.xml: cannot be written: it is read-only; nothing was changed" in ran.err
    assert (good / "package.xml").read_bytes() == before
    assert sorted(os.listdir(good)) == ["CMakeLists.txt", "package.xml"]


HOSTILE = {
    "CMakeLists.txt": ["project(x", 'set(a "', "while(1)\nendwhile()\n", "macro(m)\nm()\nendmacro()\nm()\n", "]]]]((((" * 500],
    "setup.py": [
        "while True:\n    pass\n",
        "def f():\n    f()\nf()\n",
        "x = " + "(" * 500,
        "import os; os.abort()",
        "x = 'a' * 10**12",
    ],
    "launch/a.launch.py": [
        "def generate_launch_description():\n    while True: pass\n",
        "def generate_launch_description(:",
        "\0",
    ],
    "launch/a.launch.xml": ["<launch", "<launch>" + "<group>" * 5000, '<!DOCTYPE l [<!ENTITY a "b">]><launch>&a;</launch>'],
    "launch/a.launch.yaml": ["launch:\n - &a [*a]", "launch: [", "launch:\n  - node: {pkg: !!python/object/apply:os.abort []}"],
    "src/a.cpp": ["/*" * 10000, 'R"(' * 1000, "#include <", "#if 0\n" * 1000],
    "msg/A.msg": ["a" * 100_000, "///", "int32 x y z"],
    "a.urdf": ["<robot", "<a " * 1000],
}


@pytest.mark.parametrize(("file", "content"), [(file, text) for file, texts in HOSTILE.items() for text in texts])
def test_hostile_files_end_with_a_report(tmp_path: Path, file: str, content: str) -> None:
    package(tmp_path / "good", "good")
    bad = package(tmp_path / "bad", "bad")
    if file == "setup.py":
        (bad / "package.xml").write_text(GOOD.format("bad").replace("ament_cmake</build_type>", "ament_python</build_type>"))
        (bad / "CMakeLists.txt").unlink()
    (bad / file).parent.mkdir(exist_ok=True)
    (bad / file).write_text(content)
    ran = lint(tmp_path)
    assert "undeclared-dependency" in rules(ran, "good/")
    assert ran.code == 1
    assert not [entry for entry in ran.out["not_checked"] if "failed on it" in entry["reason"]]
    assert not ran.out["crashes"]


_TRAPPED = ("json", "ntpath", "nt", "yaml", "glob", "posixpath", "pickle", "lxml", "libcst", "networkx", "ros_lint_rules")


def test_modules_of_the_workspace_are_not_loaded(tmp_path: Path) -> None:
    for number in range(60):
        package(tmp_path / f"p{number}", f"p{number}")
    python = package(tmp_path / "python", "python")
    (python / "setup.py").write_text(
        "import glob\nfrom setuptools import setup\nsetup(data_files=[('a', glob.glob('*.yaml'))])\n"
    )
    (python / "a.yaml").write_text("a:\n  ros__parameters: {b: c}\n")
    (python / "a.launch.py").write_text("import yaml\ndef generate_launch_description(): return yaml.load(open('a.yaml'))\n")
    for name in _TRAPPED:
        (tmp_path / f"{name}.py").write_text("import os\nopen(os.path.join(os.path.dirname(__file__), 'sprung'), 'w').close()\n")
    for arguments in (("check", "--jobs", "2"), ("check", "--jobs", "1", "--pedantic"), ("graph", "--format", "json")):
        command = [sys.executable, "-m", "ros_lint", *arguments]
        process = subprocess.run(command, capture_output=True, cwd=tmp_path, timeout=60, check=False)
        assert b"Traceback" not in process.stderr, process.stderr.decode()
        assert process.returncode in (0, 1), process.stderr.decode()
        assert not (tmp_path / "sprung").exists()


def test_a_version_with_too_many_digits_raises_no_error(tmp_path: Path) -> None:
    package(tmp_path / "arm", "arm")
    manifest = package(tmp_path / "robot", "robot") / "package.xml"
    depend = f'<depend version_gte="{"9" * 5000}">arm</depend>'
    manifest.write_text(GOOD.format("robot").replace("<export>", f"{depend}<export>"))
    assert "version-requirement" in rules(lint(tmp_path), "robot/package.xml")
