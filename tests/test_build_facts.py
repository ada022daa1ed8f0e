"""What is read of build scripts beside their evaluation: commands as written, lists of setup.py, names of modules, plugins."""

import importlib
import inspect
import random
import sys
from pathlib import Path

import pytest

from ros_lint.base.text import Text
from ros_lint.base.tree import MemoryTree
from ros_lint.collectors.cmake import calls as cmake_calls
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.collectors.cpp.registrations import registrations
from ros_lint.collectors.python import top_level_names as python_names
from ros_lint.collectors.resources import plugin_descriptions as plugin_xml
from ros_lint.collectors.resources.collect import collect as resource
from ros_lint.collectors.setup_py import editable_lists as setup_layout
from ros_lint.collectors.setup_py import edits as setup_edits
from ros_lint.facts.cmake import Call
from ros_lint.workspace.discovery.repository_lists import submodules

# --- CMake


def calls(text: str) -> list[Call]:
    return list(cmake_calls.collect("CMakeLists.txt", parse(Text("CMakeLists.txt", text))))


def test_what_a_command_stands_in() -> None:
    found = calls("""
install(A)
if(X)
  foreach(a b)
    install(B)
  endforeach()
elseif(BUILD_TESTING)
  install(C)
endif()
function(f)
  install(D)
endfunction()
if(NOT BUILD_TESTING)
  return()
endif()
install(E)
""")
    assert [(call.texts[0], call.blocks, call.test) for call in found] == [
        ("A", (), False),
        ("B", ("if", "foreach"), False),
        ("C", ("if",), True),
        ("D", ("function",), False),
        ("E", (), True),
    ]


def test_places_are_those_of_the_text() -> None:
    generator = random.Random(0)
    for _ in range(300):
        words = [generator.choice(["a", '"b c"', "${x}", "DESTINATION", '"é"']) for _ in range(generator.randrange(1, 8))]
        gaps = [generator.choice([" ", "\n", "\n    ", "  # why\n  ", "\r\n"]) for _ in words]
        text = "\n" * generator.randrange(3) + "  install(" + "".join(g + w for g, w in zip(gaps, words, strict=True)) + ")\n"
        source = Text("CMakeLists.txt", text)
        (call,) = calls(text)
        assert [source.slice(call.span(index)) for index in range(len(words))] == words
        assert source.slice(call.name_span) == "install"
        assert source.slice(call.extent) == text.strip()


# --- setup.py


SETUPS = {
    "comma and lines": "[\n        ('a', ['b']),\n    ]",
    "no comma": "[\n        ('a', ['b'])\n    ]",
    "one line": "[('a', ['b'])]",
    "one line with comma": "[('a', ['b']), ]",
    "comment": "[\n        ('a', ['b']),  # a, [b],\n    ]",
    "comment before the comma": "[\n        ('a', ['b'])  # a\n        ,\n    ]",
    "last is long": "[\n        ('a', [\n            'b',\n        ]),\n    ]",
}


@pytest.mark.parametrize("written", SETUPS.values(), ids=SETUPS)
def test_an_element_can_be_added(written: str) -> None:
    source = Text("setup.py", f"from setuptools import setup\npackage_name = 'robot'\nsetup(\n    data_files={written},\n)\n")
    (slot,) = setup_layout.collect(source, "robot")
    assert (slot.size, slot.variable) == (1, "package_name")
    edit = setup_edits.add(slot, f"({setup_edits.joined(slot, 'robot', 'share/')}, ['new'])")
    at = source.offset(edit.span.line, edit.span.column)
    after = source.text[:at] + edit.text + source.text[at:]
    assert data_files(after) == [*data_files(source.text), ("share/robot", ["new"])]


def data_files(text: str) -> object:
    scope: dict[str, object] = {"setup": lambda **given: scope.update(given)}
    exec(text.partition("\n")[2], scope)
    return scope["data_files"]


def test_lists_that_are_not_written_out_have_no_slot() -> None:
    texts = ("setup(data_files=files())", "setup(packages=find_packages())", "setup(data_files=[", "x = 1", "setup(); setup()")
    for text in texts:
        assert setup_layout.collect(Text("setup.py", text), "robot") == ()


# --- names of modules: against what Python itself finds in its library

MODULES = [
    "argparse", "ast", "bisect", "calendar", "cmd", "codeop", "configparser", "copy", "csv", "dataclasses", "difflib", "dis",
    "enum", "filecmp", "fnmatch", "fractions", "functools", "glob", "gzip", "heapq", "html.parser", "inspect", "json.decoder",
    "linecache", "locale", "mimetypes", "numbers", "operator", "optparse", "os", "pathlib", "pickle", "pprint", "queue",
    "random", "sched", "shlex", "shutil", "socketserver", "statistics", "string", "subprocess", "tarfile", "tempfile",
    "textwrap", "threading", "timeit", "token", "tokenize", "traceback", "typing", "uuid", "warnings", "weakref", "zipfile",
]  # fmt: skip


def test_names_are_those_that_an_import_gives() -> None:
    closed = 0
    for name in MODULES:
        module = importlib.import_module(name)
        path = inspect.getsourcefile(module)
        assert path
        found = python_names.collect(name, path, Text(path, Path(path).read_text("utf-8")))
        if found.open:
            continue
        closed += 1
        real = {attribute for attribute in vars(module) if not attribute.startswith("__")}
        below = {attribute for attribute in real if f"{name}.{attribute}" in sys.modules}
        assert real - below <= set(found.names), name
    assert closed > len(MODULES) // 2


def test_a_module_may_have_any_name() -> None:
    for text in ("from os import *", "def __getattr__(name): ...", "globals()['a'] = 1", "def main(:"):
        assert python_names.collect("m", "m.py", Text("m.py", text)).open
    assert not python_names.collect("m", "m.py", Text("m.py", "a, (b, *c) = 1, (2, 3)")).open
    assert python_names.collect("m", "m.py", Text("m.py", "a, (b, *c) = 1, (2, 3)")).names == ("a", "b", "c")


# --- plugins, components, look-ups, submodules


def test_plugin_descriptions_of_both_forms() -> None:
    one = '<library path="a">\n  <class name="n" type="p::A" base_class_type="b::B"/>\n</library>'
    for text, count in ((one, 1), (f"<class_libraries>{one}{one}</class_libraries>", 2)):
        found = plugin_xml.collect("p.xml", Text("robot/p.xml", text))
        assert found
        assert [library.path for library in found.libraries] == ["a"] * count
        assert {(c.name, c.type, c.base) for library in found.libraries for c in library.classes} == {("n", "p::A", "b::B")}
        source = Text("robot/p.xml", text)
        assert {source.slice(c.span) for library in found.libraries for c in library.classes} == {"p::A"}
    for text in ("<package/>", "<library", '<root><library path="a"/></root>', "no xml"):
        assert plugin_xml.collect("p.xml", Text("p.xml", text)) is None


def test_plugin_descriptions_that_only_pluginlib_can_read() -> None:
    text = """<?xml version="1.0"?>
<!-- ä -->
<library path="a">
  <class name="n" type="p::A<q::B>" base_class_type='b::B<q::B>'/>
</library>
<library path="c"/>
"""
    source = Text("robot/p.xml", text)
    found = plugin_xml.collect("p.xml", source)
    assert found
    assert [library.path for library in found.libraries] == ["a", "c"]
    assert [source.slice(library.span) for library in found.libraries] == ["a", "c"]
    (only,) = found.libraries[0].classes
    assert (only.type, only.base, source.slice(only.span)) == ("p::A<q::B>", "b::B<q::B>", "p::A<q::B>")
    assert source.slice(found.span) == "<library"


def test_classes_that_are_made_loadable() -> None:
    text = """
// PLUGINLIB_EXPORT_CLASS(no::A, no::B)
PLUGINLIB_EXPORT_CLASS(
  p::A<1>, ::b::B)
#define REGISTER(x) RCLCPP_COMPONENTS_REGISTER_NODE(x)
RCLCPP_COMPONENTS_REGISTER_NODE(::p::Node)
/* RCLCPP_COMPONENTS_REGISTER_NODE(no::C) */
CLASS_LOADER_REGISTER_CLASS(p::C, b::B);
RCLCPP_COMPONENTS_REGISTER_NODE( \\
  p::Continued)
"""
    found = registrations(Text("a.cpp", text))
    assert [(one.kind, one.name, one.span.line) for one in found] == [
        ("plugin", "p::A<1>", 3),
        ("component", "p::Node", 6),
        ("plugin", "p::C", 8),
        ("component", "p::Continued", 9),
    ]


def test_files_that_models_look_up() -> None:
    text = """<robot>
  <mesh filename="package://robot/meshes/a.stl"/>
  <xacro:include filename="$(find robot)/urdf/b.xacro"/>
  <mesh filename="package://robot/meshes/${name}.stl"/>
  <mesh filename="package://robot/meshes/c_${name}"/>
  <!-- <mesh filename="package://robot/meshes/d.stl"/> -->
  <mesh filename="package://robot/meshes/a.stl"/>
</robot>"""
    found = resource(Text("a.urdf.xacro", text)).lookups
    assert [(one.package, one.path, one.span.line) for one in found] == [
        ("robot", "meshes/a.stl", 2),
        ("robot", "urdf/b.xacro", 3),
    ]


def test_submodules_that_are_not_cloned() -> None:
    listed = '[submodule "a"]\n\tpath = sdk/a\n[submodule "b"]\n  path=sdk/b\n'
    tree = MemoryTree({"src/.gitmodules": listed, "src/sdk/a/CMakeLists.txt": ""})
    assert submodules(tree, ("src/.gitmodules", "x.repos")) == ("src/sdk/b",)
    assert submodules(tree, ("gone/.gitmodules",)) == ()
    windows = MemoryTree({".gitmodules": listed.replace("\n", "\r\n")})
    assert submodules(windows, (".gitmodules",)) == ("sdk/a", "sdk/b")
