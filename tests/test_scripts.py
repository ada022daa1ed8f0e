"""Build scripts as the workspace sees them: with files that are read only when a script asks for them."""

from __future__ import annotations

import pytest

from ros_lint.base.tree import MemoryTree
from ros_lint.collectors.cmake import evaluate as cmake
from ros_lint.engine import registry
from ros_lint.engine.run import find_issues
from ros_lint.facts.visibility import ALL_FACETS, Facet
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.model import Workspace
from ros_lint.workspace.target import TargetDistro
from tests.one_package import loaded
from tests.trees import Locked

XML = '<package format="3"><name>{}</name><version>1.0.0</version><description>d</description><maintainer email="a@b.cd">a'
XML += "</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend><export><build_type>ament_cmake"
XML += "</build_type></export></package>"
HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(p)\nfind_package(ament_cmake REQUIRED)\n"


def load(script: str, **files: str) -> Workspace:
    texts = {"p/package.xml": XML.format("p"), "p/CMakeLists.txt": HEAD + script}
    texts.update({name.replace("__", "/").replace("_dot_", "."): text for name, text in files.items()})
    return loaded(texts)


def installed(workspace: Workspace) -> set[str]:
    script = workspace.by_name["p"][0].script
    assert script is not None
    assert not script.opaque
    return {provided.path for provided in script.products.installs}


def test_an_included_file_may_have_any_name() -> None:
    own = "install(FILES a.yaml DESTINATION share/p)\n"
    assert "share/p/a.yaml" in installed(load("include(more.txt)\n", p__more_dot_txt=own, p__a_dot_yaml=""))


def test_a_package_within_the_package_is_installed_with_it() -> None:
    files = {"p__x__q__package_dot_xml": XML.format("q"), "p__x__q__CMakeLists_dot_txt": "", "p__x__a_dot_txt": ""}
    paths = installed(load("install(DIRECTORY x DESTINATION share/p)\n", **files))
    assert paths == {"share/p/x/a.txt", "share/p/x/q/package.xml", "share/p/x/q/CMakeLists.txt"}


def test_an_ignored_folder_is_installed_when_it_is_asked_for() -> None:
    files = {"p__x__COLCON_IGNORE": "", "p__x__sub__a_dot_txt": ""}
    assert "share/p/x/sub/a.txt" in installed(load("install(DIRECTORY x DESTINATION share/p)\n", **files))


def test_a_script_that_fails_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ValueError("oh")

    monkeypatch.setattr(cmake, "evaluate", fail)
    workspace = load("")
    reason = "ros-lint failed on this file (ValueError: oh); please report this bug"
    assert [(entry.what, entry.reason) for entry in workspace.not_checked] == [("p/CMakeLists.txt", reason)]
    assert workspace.by_name["p"][0].hidden(Facet.SHARE)


@pytest.mark.parametrize(("end", "found"), [("\r\n", ["save it with LF"]), ("\n", [])])
def test_no_interpreter_is_found_whose_name_ends_with_a_carriage_return(end: str, found: list[str]) -> None:
    text = end.join(["#!/usr/bin/env python3", "if __name__ == '__main__':", "    print(1)", ""])
    workspace = load("install(PROGRAMS a.py DESTINATION lib/${PROJECT_NAME})\nament_package()\n", p__a_dot_py=text)
    rules = [rule for rule in registry.load() if rule.name == "script-not-executable"]
    issues = find_issues((workspace,), rules, (), rules).issues
    assert [issue.finding.message.rpartition("; ")[2] for issue in issues if issue.finding.confidence == 3] == found


SETUP = {
    "p/setup.py": "from setuptools import setup\n"
    "setup(name='p', packages=['p'], entry_points={'console_scripts': ['n = p.n:main']})\n",
    "p/setup.cfg": "[develop]\nscript_dir=$base/lib/p\n[install]\ninstall_scripts=$base/lib/p\n",
    "p/p/__init__.py": "",
    "p/p/n.py": "from rclpy.node import Node\n",
    "p/src/a.cpp": "#include <std_msgs/msg/header.hpp>\n",
    "p/msg/A.msg": "std_msgs/Header header\n",
    "p/plugins.xml": "<library path='a'/>\n",
    "p/CMakeLists.txt": HEAD,
}


@pytest.mark.parametrize(
    ("locked", "build_type", "hides"),
    [
        ("p/CMakeLists.txt", "ament_cmake", ALL_FACETS),
        ("p/src/a.cpp", "ament_cmake", Facet.USES | Facet.COMPONENTS),
        ("p/msg/A.msg", "ament_cmake", Facet.USES | Facet.INTERFACES),
        ("p/plugins.xml", "ament_cmake", Facet.USES | Facet.COMPONENTS),
        ("p/p/n.py", "ament_python", Facet.USES),
        ("p/setup.py", "ament_python", ALL_FACETS),
        ("p/setup.cfg", "ament_python", ALL_FACETS),
    ],
)
def test_an_unreadable_file_hides_what_it_may_contain(locked: str, build_type: str, hides: Facet) -> None:
    texts = {"p/package.xml": XML.format("p").replace("ament_cmake", build_type), **SETUP}
    target = TargetDistro("jazzy", "test")
    seen = Loader(MemoryTree(texts), ("",), target).load().by_name["p"][0]
    workspace = Loader(Locked(texts, locked), ("",), target).load()
    package = workspace.by_name["p"][0]
    assert [(entry.what, entry.reason) for entry in workspace.not_checked] == [(locked, "Permission denied")]
    assert not seen.hidden(ALL_FACETS)
    hidden = Facet(0)
    for opaque in package.opaque:
        hidden |= opaque.hides
    assert hidden == hides
