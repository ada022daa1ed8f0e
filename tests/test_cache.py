"""Facts in the cache equal the collected facts."""

from __future__ import annotations

import os
import time
from pathlib import Path
from pkgutil import iter_modules

import pytest

from ros_lint import facts
from ros_lint.base.columns import Codec
from ros_lint.base.tree import DiskTree, Stamp
from ros_lint.workspace.cache import facts as fact_cache
from ros_lint.workspace.cache.facts import CachedFacts, FactCache
from ros_lint.workspace.cache.file import CacheFile
from ros_lint.workspace.collect import collect_all
from ros_lint.workspace.collected import Collected

FILES = {
    "p/CMakeLists.txt": "project(p)\nadd_executable(a a.cpp)\n",
    "p/a.cpp": '#include "b/c.hpp"\nRCLCPP_COMPONENTS_REGISTER_NODE(p::A)\nauto d = get_package_share_directory("q") + "/x.y";\n',
    "p/msg/A.msg": "q/B b\nc/d/e/F g\n",
    "p/config/a.yaml": "/**:\n  ros__parameters:\n    file: $(find-pkg-share q)/a.b\n",
    "p/launch/a.launch.xml": '<launch><arg name="x" default="1"/><node pkg="p" exec="a" if="$(var x)"/></launch>\n',
    "p/launch/b.launch.py": """import os
import yaml
from launch import LaunchDescription
from launch_ros.actions import Node
from ament_index_python.packages import get_package_share_directory


def generate_launch_description():
    path = os.path.join(get_package_share_directory("p"), "config", "a.yaml")
    with open(path) as file:
        values = yaml.safe_load(file)
    more = yaml.safe_load(open("config/b.yaml"))
    return LaunchDescription([Node(package="p", executable=name, parameters=[path]) for name in values["nodes"]])
""",
    "p/setup.py": "import q  # ros-lint: ignore[undeclared-dependency] why\nx = __import__(name)\n",
    "p/Cargo.toml": '[dependencies]\nrclrs = "*"\n',
}


@pytest.fixture
def tree(tmp_path: Path) -> DiskTree:
    for name, text in FILES.items():
        write(tmp_path / "ws" / name, text)
    return DiskTree(str(tmp_path / "ws"))


def write(path: Path, text: str, age: float = 60) -> None:
    """Write a file in place and set its modification time to ``age`` seconds before now."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as file:
        file.write(text)
    os.utime(path, (time.time() - age,) * 2)


@pytest.fixture(autouse=True)
def stamps_without_change_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a test set all times of a stamp, as tools set the times of files on a system without change times."""
    stamp = DiskTree.stamp
    monkeypatch.setattr(DiskTree, "stamp", lambda self, path: stamp(self, path)._replace(changed=0))


def cache(tree: DiskTree) -> FactCache:
    return FactCache(CacheFile(tree.place("../cache"), tree.place("")))


def run(tree: DiskTree, *names: str) -> dict[str, Collected]:
    return collect_all(tree, list(names or FILES), 1, cache(tree), lambda processed: None)


def cached(tree: DiskTree) -> dict[str, Collected]:
    return {path: file.collected for path, file in cache(tree).fetch(tree, tree, list(FILES)).items()}


def segments(tree: DiskTree) -> list[int]:
    return [
        len(segment) for segment in cache(tree)._file.read(lambda name: name.startswith("facts-"), fact_cache._codec()).values()
    ]


def test_cached_facts_equal_fresh_facts(tree: DiskTree) -> None:
    collected = run(tree)
    assert not any(facts.unreadable for facts in collected.values())
    assert cached(tree) == collected
    assert repr(cached(tree)) == repr(collected)  # which contains the classes, too
    write(Path(tree.place("p/a.cpp")), "#include <d/e.hpp>\n")
    assert set(cached(tree)) == set(FILES) - {"p/a.cpp"}


def test_a_file_with_another_time_and_the_same_contents_is_unchanged(tree: DiskTree, monkeypatch: pytest.MonkeyPatch) -> None:
    collected = run(tree)
    for name, text in FILES.items():
        Path(tree.place(name)).unlink()
        write(Path(tree.place(name)), text, age=30)  # as a new clone has it
    assert cached(tree) == collected
    assert run(tree) == collected  # stores the new stamps
    monkeypatch.setattr(DiskTree, "read", lambda self, path: 1 / 0)
    assert cached(tree) == collected
    Path(tree.place("p/a.cpp")).chmod(0o755)
    monkeypatch.undo()
    assert set(cached(tree)) == set(FILES) - {"p/a.cpp"}


@pytest.mark.parametrize("age", [0, 1.5, -1000], ids=["now", "a moment ago", "in the future"])
def test_a_change_within_a_tick_of_the_clock_is_noticed(tree: DiskTree, age: float) -> None:
    source = Path(tree.place("p/a.cpp"))
    write(source, "#include <b/c.hpp>\n", age)
    before = source.stat()
    first = run(tree)["p/a.cpp"]
    assert cached(tree)["p/a.cpp"] == first
    source.write_text("#include <x/y.hpp>\n")
    os.utime(source, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert tree.stamp("p/a.cpp") == Stamp(before.st_mtime_ns, before.st_size, before.st_mode & 0o777, 0, before.st_ino)
    assert "p/a.cpp" not in cached(tree)
    assert run(tree)["p/a.cpp"] != first
    assert cached(tree)["p/a.cpp"] == run(tree)["p/a.cpp"]


def test_contents_are_compared_only_until_the_stamp_is_settled(tree: DiskTree, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in FILES.items():
        write(Path(tree.place(name)), text, age=0)
    collected = run(tree)
    now = time.time_ns
    monkeypatch.setattr(time, "time_ns", lambda: now() + 10_000_000_000)
    assert run(tree) == collected  # reads, and stores that the stamps are settled
    monkeypatch.setattr(DiskTree, "read", lambda self, path: 1 / 0)
    assert run(tree) == collected


def test_the_number_of_segments_grows_with_the_logarithm(tree: DiskTree) -> None:
    names = [f"p/a{number}.cpp" for number in range(40)]
    for name in names:
        write(Path(tree.place(name)), f"#include <{name}/b.hpp>\n")
    run(tree, *names)
    assert segments(tree) == [40]
    for number, name in enumerate(names[:12]):
        write(Path(tree.place(name)), f"#include <new/b{number}.hpp>\n")
        assert run(tree, *names)[name].facts.mentions[0].name == f"new/b{number}.hpp"  # type: ignore[union-attr]
        assert segments(tree)[0] == 40
        assert len(segments(tree)) <= 4
    for name in names[:30]:
        write(Path(tree.place(name)), "#include <last/b.hpp>\n")
    run(tree, *names)
    assert segments(tree) == [40]
    Path(tree.place(names[0])).unlink()
    for name in names[1:]:
        write(Path(tree.place(name)), "#include <end/b.hpp>\n")
    run(tree, *names[1:])
    assert segments(tree) == [39]


def test_facts_of_files_outside_the_run_are_kept(tree: DiskTree) -> None:
    collected = run(tree)
    write(Path(tree.place("p/a.cpp")), "#include <d/e.hpp>\n")
    changed = run(tree, "p/a.cpp")
    assert cached(tree) == {**collected, **changed}


def test_files_that_cannot_be_read_are_not_cached(tree: DiskTree) -> None:
    Path(tree.place("p/a.cpp")).unlink()
    Path(tree.place("p/a.cpp")).symlink_to("/etc/hostname")
    assert run(tree)["p/a.cpp"].unreadable
    assert set(cached(tree)) == set(FILES) - {"p/a.cpp"}


def test_facts_of_another_version_are_not_read(tree: DiskTree, monkeypatch: pytest.MonkeyPatch) -> None:
    run(tree)
    monkeypatch.setattr(fact_cache, "_state", lambda: "new")
    assert cached(tree) == {}
    run(tree)
    assert segments(tree) == [len(FILES)]  # those of the other version are removed


def test_all_facts_can_be_cached_until_their_code_changes() -> None:
    schema = Codec(CachedFacts).schema
    assert {f"{kind}'" in schema for kind in ("facts.launch.LaunchAction", "facts.sources.Mention", "cmake.syntax.Command")} == {
        True
    }
    modules = {Path(facts.__path__[0], f"{module.name}.py") for module in iter_modules(facts.__path__)}
    watched: list[str] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fact_cache, "state_of", lambda paths, schema: watched.extend(paths))
        fact_cache._state.__wrapped__()
    assert modules <= set(map(Path, watched))
    assert {"columns.py", "collect.py", "collected.py"} <= {path.rpartition("/")[2] for path in watched}
