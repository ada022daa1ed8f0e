"""Files are written completely or not at all, and never over concurrent changes."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from ros_lint.analysis.finding import Fix
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, Text
from ros_lint.engine import edits
from tests.test_bad_input import Ran, lint, package, rules

pytestmark = pytest.mark.slow

CHANGED = "changed since it was read; fix skipped"


@pytest.fixture
def two(tmp_path: Path) -> Path:
    """A folder with two files."""
    for name in "ab":
        (tmp_path / name).write_bytes(b"old")
    return tmp_path


BEFORE = {"a": b"old", "b": b"old"}
AFTER = {"a": b"new", "b": b"new"}


@pytest.mark.parametrize("what", ["other bytes", "removed", "a folder"])
def test_a_changed_file_prevents_all_changes(two: Path, what: str) -> None:
    (two / "b").unlink()
    if what == "other bytes":
        (two / "b").write_bytes(b"mine")
    elif what == "a folder":
        (two / "b").mkdir()
    with pytest.raises(edits.EditError, match=f"^b: {CHANGED}; nothing was changed$"):
        edits.write_all(str(two), AFTER, BEFORE)
    assert (two / "a").read_bytes() == b"old"


def test_a_file_created_meanwhile_is_kept(two: Path) -> None:
    with pytest.raises(edits.EditError, match=f"^b: {CHANGED}; nothing was changed$"):
        edits.write_all(str(two), AFTER, {"a": b"old"})
    assert (two / "b").read_bytes() == b"old"


def test_a_file_that_changes_while_others_are_written_is_kept(two: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    replace = os.replace

    def slow(source: str, target: str) -> None:
        replace(source, target)
        (two / "b").write_bytes(b"mine")

    monkeypatch.setattr(os, "replace", slow)
    with pytest.raises(edits.EditError, match=f"^b: {CHANGED}; written already: a; not written: b$") as raised:
        edits.write_all(str(two), AFTER, BEFORE)
    assert raised.value.written == ("a",)
    assert {path.name: path.read_bytes() for path in two.iterdir()} == {"a": b"new", "b": b"mine"}


@pytest.mark.parametrize(
    ("fails", "result"),
    [
        ("a", "nothing was changed"),
        ("b", "written already: a; not written: b, c, d"),
        ("c", "written already: a, b; not written: c, d"),
    ],
)
def test_a_failing_disk_is_reported_with_the_files_written_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: str, result: str
) -> None:
    before, after = dict.fromkeys("abcd", b"old"), dict.fromkeys("abcd", b"new")
    for name in before:
        (tmp_path / name).write_bytes(b"old")
    replace = os.replace

    def failing(source: str, target: str) -> None:
        if target.endswith(fails):
            raise OSError(27, os.strerror(27))
        replace(source, target)

    monkeypatch.setattr(os, "replace", failing)
    with pytest.raises(edits.EditError, match=f"^{fails}: cannot be written: File too large; {result}$"):
        edits.write_all(str(tmp_path), after, before)
    assert {path.name for path in tmp_path.iterdir() if path.read_bytes() == b"new"} == {name for name in before if name < fails}
    assert {path.name for path in tmp_path.iterdir()} == set(before)


@pytest.mark.parametrize("missing", [os.W_OK, os.X_OK], ids=["write", "search"])
def test_a_folder_without_permission_prevents_all_changes(two: Path, monkeypatch: pytest.MonkeyPatch, missing: int) -> None:
    """The folder belongs to somebody else, so its permission bits say nothing."""
    (two / "d").mkdir()
    (two / "d" / "c").write_bytes(b"old")
    access = os.access
    monkeypatch.setattr(os, "access", lambda place, mode: access(place, mode) and not (place.endswith("d") and mode & missing))
    with pytest.raises(edits.EditError, match="^d/c: cannot be written: no permission .*; nothing was changed$"):
        edits.write_all(str(two), {"a": b"new", "d/c": b"new"}, {"a": b"old", "d/c": b"old"})
    assert (two / "a").read_bytes() == b"old"


def test_an_interruption_leaves_no_temporary_file(two: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        edits.write_all(str(two), AFTER, BEFORE)
    assert {path.name: path.read_bytes() for path in two.iterdir()} == BEFORE


def test_new_contents_are_on_the_disk_before_they_replace_the_old(two: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    events: list[object] = []
    replace = os.replace

    def replaced(source: str, target: str) -> None:
        events.append(os.path.basename(target))
        replace(source, target)

    monkeypatch.setattr(os, "fsync", lambda handle: events.append(os.fstat(handle).st_size))
    monkeypatch.setattr(os, "replace", replaced)
    edits.write_all(str(two), {"a": b"longer", "b": b"new"}, BEFORE)
    assert events == [6, "a", 3, "b"]


def test_a_link_with_the_name_of_a_temporary_file_is_kept(two: Path) -> None:
    link = two / ".ros-lint-abcdefgh.part"
    link.symlink_to("b")
    os.utime(two / "b", (0, 0))
    edits.write_all(str(two), {"a": b"new"}, {"a": b"old"})
    assert link.is_symlink()


def test_temporary_files_of_killed_runs_are_removed(two: Path) -> None:
    old = [".ros-lint-a_b1c2d3.part", ".ros-lint-a_b1c2d3.json", ".ros-lint-abc.part", "x.ros-lint-abcdefgh.part"]
    for name in (*old, ".ros-lint-abcdefgh.part"):
        (two / name).write_bytes(b"")
    for name in old:
        os.utime(two / name, (0, 0))
    edits.write_all(str(two), AFTER, BEFORE)
    assert {path.name for path in two.iterdir()} == {"a", "b", *old[1:], ".ros-lint-abcdefgh.part"}


def test_an_edit_with_a_line_beyond_the_text_is_rejected() -> None:
    fix = Fix("", (Edit(Span("f", 3, 1, 3, 2), "x"),))
    with pytest.raises(edits.EditError, match=f"^f: {CHANGED}$"):
        edits.apply([fix], lambda path: Text(path, "one\n"))


# --- with a rule that writes while it looks -----------------------------------------------------------------------

RULE = """
import os
from ros_lint.api import Rule, Severity
CALLS = []
def check(package, workspace):
    if package.name == {package!r}:
        CALLS.append(len(package.declared))  # what the fix changes, so that its trial runs the rule again
        if len(CALLS) == {call}:
            with open({path!r}, "w") as file:
                file.write({text!r})
    return ()
RULE = Rule("writes", "MY001", "s", Severity.ERROR, "1.0", "", package=check)
"""


def run_with(site: Path, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Run with a folder on the path of Python."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])}
    command = [sys.executable, "-m", "ros_lint", *map(str, arguments), "--no-cache", "--distro", "jazzy"]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, env=env)


def lint_while_writing(tmp_path: Path, place: Path, text: str, call: int, flag: str = "--fix") -> Ran:
    """Fix a workspace in which somebody writes a file the n-th time that the rules run."""
    site = tmp_path / "site"
    (site / "mine-1.0.dist-info").mkdir(parents=True)
    (site / "mine-1.0.dist-info" / "METADATA").write_text("Metadata-Version: 2.1\nName: mine\nVersion: 1.0\n")
    (site / "mine-1.0.dist-info" / "entry_points.txt").write_text("[ros_lint.rules]\nmine = mine_rules\n")
    (site / "mine_rules.py").write_text(RULE.format(package=place.parent.name, call=call, path=str(place), text=text))
    path = os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-m", "ros_lint", str(tmp_path / "ws"), flag, "--plugins", "--no-cache", "--distro", "jazzy"]
    process = subprocess.run(
        command, capture_output=True, text=True, timeout=60, check=False, env={**os.environ, "PYTHONPATH": path}
    )
    assert "Traceback" not in process.stderr
    return Ran(process.returncode, {}, process.stderr, process.stdout)


def test_a_file_that_changes_before_its_fix_is_fixed_with_its_new_text(tmp_path: Path) -> None:
    place = package(tmp_path / "ws" / "robot", "robot") / "package.xml"
    text = place.read_text()
    short = " ".join(text.split("\n")).replace("<license>", "<license>BSD-3-Clause</license><license>")
    ran = lint_while_writing(tmp_path, place, short, 1)
    assert ran.code == 0
    assert place.read_text().replace("<depend>sensor_msgs</depend>", "").split() == short.split()
    assert "<depend>sensor_msgs</depend>" in place.read_text()


def test_a_file_that_changes_after_it_was_read_is_not_overwritten(tmp_path: Path) -> None:
    for name in ("arm", "leg"):
        package(tmp_path / "ws" / name, name)
    place = tmp_path / "ws" / "leg" / "package.xml"
    mine = place.read_text().replace("Good.", "Mine.")
    ran = lint_while_writing(tmp_path, place, mine, 2)
    assert ran.code == 2
    assert f"ros-lint: leg/package.xml: {CHANGED}; nothing was changed" in ran.err
    assert place.read_text() == mine
    assert "sensor_msgs" not in (tmp_path / "ws" / "arm" / "package.xml").read_text()
    assert "Found 2 errors" in ran.text


def test_a_patch_uses_one_state_of_each_file(tmp_path: Path) -> None:
    place = package(tmp_path / "ws" / "robot", "robot") / "package.xml"
    patch = lint_while_writing(tmp_path, place, " ".join(place.read_text().split("\n")), 2, "--diff").text
    assert [line for line in patch.splitlines() if line.startswith(("+ ", "-  "))] == ["+  <depend>sensor_msgs</depend>"]


def test_files_written_before_a_failure_are_reported_as_fixed(tmp_path: Path) -> None:
    for name in ("arm", "leg"):
        package(tmp_path / "ws" / name, name)
    site = tmp_path / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(
        "import os\nreplace = os.replace\n"
        "def failing(source, target):\n"
        "    if 'leg' in target:\n        raise OSError(27, os.strerror(27))\n"
        "    replace(source, target)\n"
        "os.replace = failing\n"
    )
    path = os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-m", "ros_lint", str(tmp_path / "ws"), "--fix", "--no-cache", "--format", "concise"]
    process = subprocess.run(
        command, capture_output=True, text=True, timeout=60, check=False, env={**os.environ, "PYTHONPATH": path}
    )
    assert process.returncode == 2
    expected = (
        "leg/package.xml: cannot be written: File too large; written already: arm/package.xml; not written: leg/package.xml"
    )
    assert expected in process.stderr
    assert process.stdout.startswith("leg/CMakeLists.txt:4")
    assert "arm/" not in process.stdout


# --- reports ------------------------------------------------------------------------------------------------------


def test_a_report_is_written_completely_or_not_at_all(tmp_path: Path) -> None:
    package(tmp_path / "ws" / "robot", "robot")
    place = tmp_path / "report"
    place.write_text("of yesterday")
    place.chmod(0o640)
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(
        "import resource, signal\nsignal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))\n"
    )
    process = run_with(tmp_path / "site", tmp_path / "ws", "--output", place)
    assert process.returncode == 2
    assert process.stderr == f"ros-lint: {place}: cannot be written: File too large\n"
    assert place.read_text() == "of yesterday"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["report", "site", "ws"]
    assert lint(tmp_path / "ws", "--output", place, text=True).code == 1
    assert place.read_text().startswith("robot: 1 finding")
    assert place.stat().st_mode & 0o777 == 0o640


def test_a_report_is_written_to_a_device_and_through_a_link(tmp_path: Path) -> None:
    package(tmp_path / "ws" / "robot", "robot")
    ran = lint(tmp_path / "ws", "--output", "/dev/stdout")
    assert rules(ran, "robot/") == ["undeclared-dependency"]
    assert lint(tmp_path / "ws", "--output", "/dev/null").code == 1
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real/report")
    assert lint(tmp_path / "ws", "--output", tmp_path / "link").code == 1
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real" / "report").read_text().startswith("{")
    ran = lint(tmp_path / "ws", "--output", tmp_path / "nowhere" / "report")
    assert ran.code == 2
    assert "nowhere/report: cannot be written: No such file or directory" in ran.err


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can give files to other users")
def test_a_changed_file_keeps_its_owner(two: Path) -> None:
    os.chown(two / "a", 1234, 4321)
    (two / "a").chmod(0o640)
    edits.write_all(str(two), AFTER, BEFORE)
    status = (two / "a").stat()
    assert (two / "a").read_bytes() == b"new"
    assert (status.st_uid, status.st_gid, status.st_mode & 0o7777) == (1234, 4321, 0o640)


@pytest.mark.skipif(not hasattr(os, "setxattr"), reason="this system has no extended attributes")
def test_a_changed_file_keeps_its_extended_attributes(two: Path) -> None:
    with suppress(OSError):  # not every file system has them
        os.setxattr(two / "a", "user.note", b"kept")
    attributes = {name: os.getxattr(two / "a", name) for name in os.listxattr(two / "a")}
    edits.write_all(str(two), AFTER, BEFORE)
    assert (two / "a").read_bytes() == b"new"
    assert {name: os.getxattr(two / "a", name) for name in os.listxattr(two / "a")} == attributes
