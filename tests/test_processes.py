"""Rules in several processes: the same bytes as in one process, whatever happens to a process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from ros_lint.base import processes
from ros_lint.base.recorded_tree import RecordedTree
from ros_lint.base.tree import DiskTree
from tests.packages import manifest_text

DEMO = Path(__file__).parent.parent / "fixtures" / "workspaces" / "demo"

# Processes are copied in a process of its own, because pytest can have threads. It has 4 cores on any machine.
_RUN = """
import os, sys
from ros_lint.base import processes
from ros_lint.cli.main import main
from ros_lint.engine import parallel
import ros_lint_rules.unused_dependency as module

parallel.available_cores = lambda: 4
first, copy, copies = os.getpid(), processes._copy, []

def counted(function, queue):
    copies.append(0)
    return copy(function, queue)

processes._copy = counted
{}
code = main(sys.argv[1:])
print(len(copies), file=sys.stderr)
sys.exit(code)
"""

_KILLED = """
def killed(function, queue, run=processes._results):
    results = run(function, queue)
    if os.getpid() != first:
        os.kill(os.getpid(), 9)
    return results

processes._results = killed
"""
_CUT_OFF = """
def cut_off(results, file, protocol):
    file.write(pickle.dumps(results, protocol)[:-1])

import pickle
pickle.dump = cut_off
"""
_CRASHING = """
def check(package, workspace):
    yield from RULE.package(package, workspace)
    if "o" in package.name:
        raise ValueError(package.name)

RULE = module.RULE
module.RULE = RULE._replace(package=check)
"""
_WITHOUT_DATA = """
from ros_lint.knowledge.store import KnowledgeError

def check(package, workspace):
    raise KnowledgeError(f"no data for {package.name}")
    yield

module.RULE = module.RULE._replace(package=check)
"""
_UNREADABLE_IN_COPIES = """
from ros_lint.knowledge.store import KnowledgeError

def check(package, workspace):
    if os.getpid() != first:
        raise KnowledgeError("")
    yield from RULE.package(package, workspace)

RULE = module.RULE
module.RULE = RULE._replace(package=check)
"""
_NOT_PICKLABLE = """
class Word(str):
    def __reduce__(self):
        raise TypeError

def check(package, workspace):
    for finding in RULE.package(package, workspace):
        yield finding._replace(subject=Word(finding.subject))

RULE = module.RULE
module.RULE = RULE._replace(package=check)
"""


def lint(workspace: Path, jobs: int, change: str = "", *arguments: str) -> tuple[int, str, str, int]:
    """Return exit code, output, messages and the number of copies of the process."""
    command = [sys.executable, "-c", _RUN.format(change), str(workspace), "--distro", "jazzy", "--no-cache", "--pedantic"]
    environment = {**os.environ, "AMENT_PREFIX_PATH": ""}
    process = subprocess.run(
        [*command, "--format", "json", "--jobs", str(jobs), *arguments],
        capture_output=True, check=False, text=True, env=environment, timeout=100,
    )  # fmt: skip
    *messages, copies = process.stderr.splitlines()
    return process.returncode, process.stdout, "\n".join(messages), int(copies)


@pytest.fixture
def many_packages(tmp_path: Path) -> Path:
    """Return a workspace of 60 packages with findings of rules for packages and for workspaces."""
    for number in range(60):
        folder = tmp_path / f"p{number}"
        folder.mkdir()
        tags = [f"<depend>{name}</depend>" for name in (f"p{number + 1}", "rclcpp", "std_msgz")]
        (folder / "package.xml").write_text(manifest_text(f"p{number}", tags))
        (folder / "CMakeLists.txt").write_text(
            f"project(p{number})\nfind_package(ament_cmake REQUIRED)\nadd_library(a a.cpp)\nament_package()\n"
        )
        (folder / "a.cpp").write_text("#include <geometry_msgs/msg/pose.hpp>\n")
    return tmp_path


def test_the_output_of_many_packages_is_the_same_with_any_number_of_processes(many_packages: Path) -> None:
    expected = lint(many_packages, 1)
    assert expected[0] == 1
    assert expected[3] == 0
    for jobs, copies in ((0, 1), (2, 1), (1000, 3)):
        assert lint(many_packages, jobs) == (*expected[:3], copies)


@pytest.mark.parametrize(
    "change",
    ["", _KILLED, _CUT_OFF, _CRASHING, _UNREADABLE_IN_COPIES, _NOT_PICKLABLE, _WITHOUT_DATA],
    ids=["sound", "killed", "cut off", "crashing rule", "unreadable in copies", "not picklable", "without data"],
)
def test_the_output_is_the_same_whatever_happens_in_a_process(change: str) -> None:
    expected = lint(DEMO, 1, change)
    assert expected[0] == (2 if change in {_CRASHING, _WITHOUT_DATA} else 1), expected[2]
    assert lint(DEMO, 4, change) == (*expected[:3], 3)


def test_several_distributions_are_checked_in_several_processes() -> None:
    expected = lint(DEMO, 1, "", "--distro", "humble,jazzy")
    assert lint(DEMO, 3, "", "--distro", "humble,jazzy") == (*expected[:3], 2)


def test_what_a_process_reads_of_an_underlay_is_recorded_for_the_next_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    share = tmp_path / "underlay" / "share"
    for name in ("rclcpp", "std_msgs", "sensor_msgs"):
        (share / "ament_index" / "resource_index" / "packages").mkdir(parents=True, exist_ok=True)
        (share / "ament_index" / "resource_index" / "packages" / name).touch()
        (share / name).mkdir()
        (share / name / "package.xml").write_text(manifest_text(name))
    record = """
from ros_lint.base import recorded_tree
answers = recorded_tree.RecordedTree.answers

def shown(tree):
    asked = sorted(map(str, tree._answers)) + sorted(tree._digests)
    print(len(asked), asked, file=sys.stderr)
    return answers.fget(tree)

recorded_tree.RecordedTree.answers = property(shown)
"""
    options = ("--cache", "--underlay", str(tmp_path / "underlay"))
    asked = []
    for jobs in (1, 4):
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / str(jobs)))
        asked.append(lint(DEMO, jobs, record, *options)[2])
    assert "share/sensor_msgs/package.xml" in asked[0]
    assert asked[0] == asked[1]


def test_queries_are_sent_once(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("a")
    first, other = (RecordedTree(DiskTree(str(tmp_path))) for _ in range(2))
    first.list("")
    first.new_queries()
    first.read("a")
    queries = first.new_queries()
    assert list(queries.answers) == [("stamp", "a")]
    assert not first.new_queries().answers
    other.list("")
    other.add(queries)
    assert other.answers == first.answers
    (tmp_path / "a").write_text("changed")
    other.add(RecordedTree(DiskTree(str(tmp_path))).new_queries())
    assert other.steady
    third = RecordedTree(DiskTree(str(tmp_path)))
    third.read("a")
    other.add(third.new_queries())
    assert not other.steady


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no affinity")
def test_only_the_cores_of_this_process_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {3, 5})
    assert processes.available_cores() == 2


def test_calls_that_raise_an_exception_have_no_result() -> None:
    assert processes.call_all(lambda number: 12 // number, 4, 1) == {1: 12, 2: 6, 3: 4}
