"""Facts in the cache equal the collected facts."""

from __future__ import annotations

from pathlib import Path
from pkgutil import iter_modules

import pytest

from ros_lint import facts
from ros_lint.analysis.finding import Severity
from ros_lint.base.tree import DiskTree
from ros_lint.facts.visibility import Facet
from ros_lint.workspace import cache_files
from ros_lint.workspace import fact_cache as cache
from ros_lint.workspace.collect import Collected, collect_all
from ros_lint.workspace.fact_cache import FactCache

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


def test_cached_facts_equal_fresh_facts(tmp_path: Path) -> None:
    for name, text in FILES.items():
        path = tmp_path / "ws" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    tree = DiskTree(str(tmp_path / "ws"))
    collected = collect_all(tree, list(FILES), 1, FactCache(str(tmp_path / "cache"), "ws"), lambda processed: None)
    assert not any(facts.unreadable for facts in collected.values())
    cached = FactCache(str(tmp_path / "cache"), "ws").fetch(tree, list(FILES), Collected)
    assert cached == collected
    assert repr(cached) == repr(collected)  # which tells the classes, too
    (tmp_path / "ws" / "p" / "a.cpp").write_text("#include <d/e.hpp>\n")
    assert set(FactCache(str(tmp_path / "cache"), "ws").fetch(tree, list(FILES), Collected)) == set(FILES) - {"p/a.cpp"}


def test_enumerations_are_cached_in_every_pickle_form(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Facet, "__reduce_ex__", lambda self, _: (getattr, (Facet, self.name)))
    enumerations = (Facet.USES, Facet.USES | Facet.SHARE, Severity.ERROR)
    cache_files.save(str(tmp_path / "kept"), "state", enumerations)
    assert cache_files.load(str(tmp_path / "kept"), "state") == enumerations


def test_all_facts_can_be_cached_until_their_code_changes() -> None:
    modules = list(iter_modules(facts.__path__))
    names = {f"ros_lint.facts.{module.name}" for module in modules} - {"ros_lint.facts.environment"}  # which has no class
    assert names <= set(cache_files.MODULES)
    assert {Path(facts.__path__[0], f"{module.name}.py") for module in modules} <= set(map(Path, cache._collectors()))
