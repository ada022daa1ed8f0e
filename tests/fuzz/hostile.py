"""Hostile seeds: inputs that were written by hand to exhaust the stack, the memory or the time.

Most are the same few attacks in every format: brackets and words of any length, characters that editors do not show, numbers
without end. The others use what only one format has: entities, anchors, macros, patterns, loops.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final

from tests.fuzz.seeds import Files, Other
from tests.fuzz.targets import _PACKAGE, _PYTHON, BASELINE, WHOLE

DEEP: Final = 20_000
LONG: Final = 200_000

_MANIFEST: Final = _PACKAGE["q/package.xml"]
_LAUNCH_HEAD: Final = (
    "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch.substitutions import *\n"
    "from launch_ros.actions import Node\nimport os, yaml\n\ndef generate_launch_description():\n"
)


def _cmake(body: str) -> str:
    return f"cmake_minimum_required(VERSION 3.8)\nproject(q)\nfind_package(ament_cmake)\n{body}\nament_package()\n"


def _launch(body: str) -> str:
    inner = "".join(f"    {line}\n" for line in body.splitlines())
    return f"{_LAUNCH_HEAD}    x = []\n{inner}    return LaunchDescription([Node(package='q', executable=str(x))])\n"


def _setup(body: str) -> str:
    return f"from setuptools import setup\nfrom glob import glob\nimport os\n{body}\nsetup(name='r', version='0.1.0', packages=['r'])\n"


def _manifest(tags: str) -> str:
    return _MANIFEST.replace("  <export>", f"{tags}  <export>")


def _field(value: str) -> str:
    return f"a: {value}\n"


_FORMATS: Final[Mapping[str, tuple[str, str, Callable[[str], str]]]] = {
    # target: the file, its comment sign, and a function that puts a value where values of the format are
    "manifest": ("q/package.xml", "", lambda value: _manifest(f"  <depend>{value}</depend>\n")),
    "cmake": ("q/CMakeLists.txt", "#", lambda value: _cmake(f"set(a {value})\ninstall(FILES ${{a}} DESTINATION share/q)")),
    "setup.py": ("r/setup.py", "#", lambda value: _setup(f"x = {value}")),
    "setup.cfg": ("r/setup.cfg", "#", lambda value: f"[options]\ninstall_requires = {value}\n"),
    "pyproject": ("r/pyproject.toml", "#", lambda value: f'[project]\nname = "r"\ndependencies = [{value}]\n'),
    "python": ("r/r/n.py", "#", lambda value: f"import rclpy\nx = {value}\n"),
    "launch.py": ("q/launch/a.launch.py", "#", lambda value: _launch(f"x = {value}")),
    "launch.xml": ("q/launch/a.launch.xml", "", lambda value: f'<launch><node pkg="q" exec="n" name="{value}"/></launch>'),
    "launch.yaml": ("q/launch/b.launch.yaml", "#", lambda value: f"launch:\n- node: {{pkg: q, exec: n, name: {value}}}\n"),
    "c++": ("q/src/n.cpp", "//", lambda value: f"#include <{value}>\nauto x = {value};\n"),
    "interfaces": ("q/msg/A.msg", "#", lambda value: f"{value} a\nint32 B={value}\n"),
    "idl": ("q/msg/B.idl", "//", lambda value: f"module q {{ module msg {{ struct B {{ sequence<{value}> a; }}; }}; }};\n"),
    "parameters": ("q/config/p.yaml", "#", lambda value: f"/**:\n  ros__parameters:\n    a: {value}\n"),
    "robots": ("q/urdf/a.urdf.xacro", "", lambda value: f'<robot><mesh filename="package://{value}"/></robot>'),
    "rviz": ("q/rviz/a.rviz", "#", _field),
    "repositories": ("a.repos", "#", lambda value: f"repositories:\n  b: {{type: git, url: {value}}}\n"),
    "gitmodules": (".gitmodules", "#", lambda value: f'[submodule "{value}"]\n\tpath = {value}\n'),
    "colcon": ("q/colcon.pkg", "#", lambda value: f"name: {value}\n"),
    "colcon.meta": ("colcon.meta", "#", lambda value: f"names:\n  q: {{dependencies: {value}}}\n"),
    "ignore files": (".gitignore", "#", lambda value: f"{value}\n/{value}/**\n!{value}\n"),
    "settings": ("ros-lint.toml", "#", lambda value: f"exclude = [{value}]\n"),
    BASELINE: ("known.json", "", lambda value: f'{{"folders": [], "known": {value}}}'),
    "suppressions": ("q/src/s.cpp", "//", lambda value: f"// ros-lint: ignore[{value}] {value}\n"),
    "resources": ("q/plugins.xml", "", lambda value: f'<library path="{value}"><class type="{value}"/></library>'),
    "java": ("q/src/A.java", "//", lambda value: f"import {value};\n"),
}

_VALUES: Final[Mapping[str, str]] = {
    "brackets": "[" * DEEP + "]" * DEEP,
    "parentheses": "(" * DEEP + "a" + ")" * DEEP,
    "braces": "{" * DEEP + "}" * DEEP,
    "tags": "<a>" * DEEP + "</a>" * DEEP,
    "dashes": "- " * DEEP,
    "question marks": "? " * DEEP,
    "variables": "${" * DEEP + "a" + "}" * DEEP,
    "substitutions": "$(" * DEEP + "var a" + ")" * DEEP,
    "angles": "<" * LONG,
    "a word": "a" * LONG,
    "words": "a " * LONG,
    "attributes": "a.b" + ".c" * DEEP,
    "quotes": '"' * LONG,
    "apostrophes": "'" * LONG,
    "backslashes": "\\" * LONG,
    "line continuations": "\\\n" * LONG,
    "blanks": " " * LONG + "a",
    "empty lines": "\n" * LONG + "a",
    "slashes": "a/" * DEEP,
    "stars": "*a" * 2_000 + "b",
    "double stars": "**/" * 2_000 + "b",
    "a number": "9" * 20_000,
    "an exponent": "1e" + "9" * 20_000,
    "NUL": "a\0b",
    "control characters": "".join(map(chr, range(1, 32))),
    "directions": "a\u202eb\u2066c\u200f",
    "separators": "a\u2028b\u2029c\x85d\x0ce",
    "surrogates": "\\ud800\\udfff",
    "combining characters": "e" + "\u0301" * DEEP,
    "terminal": "\x1b]0;a\x07\x1b[2J\x9b31m",
    "comments": "/*" * DEEP,
    "bounds": "a<=" * DEEP,
    "not": "not " * DEEP + "a",
    "minus": "-" * DEEP + "1",
    "lambda": "lambda: " * DEEP + "1",
    "f-strings": "f'{" * 200 + "a" + "}'" * 200,
    "calls": "f" + "()" * DEEP,
    "conditions": "a if b else " * DEEP + "c",
}

_BOMB: Final = (
    "<!DOCTYPE p [<!ENTITY a0 'aaaaaaaaaa'>" + "".join(f"<!ENTITY a{n + 1} '{f'&a{n};' * 10}'>" for n in range(12)) + "]>"
)
_ANCHORS: Final = "a0: &a0 [x, x]\n" + "".join(f"a{n + 1}: &a{n + 1} [*a{n}, *a{n}]\n" for n in range(40))


def _own() -> Iterator[tuple[str, str, Files]]:
    """Yield what only one format has: the target, a name, and files."""
    yield from (("manifest", name, {"q/package.xml": text}) for name, text in _MANIFESTS.items())
    yield from (("cmake", name, {"q/CMakeLists.txt": _cmake(text)}) for name, text in _SCRIPTS.items())
    yield from (("setup.py", name, {"r/setup.py": _setup(text)}) for name, text in _SETUPS.items())
    yield from (("launch.py", name, {"q/launch/a.launch.py": _launch(text)}) for name, text in _LAUNCHES.items())
    yield from (("launch.xml", name, {"q/launch/a.launch.xml": text}) for name, text in _XML.items())
    for name, text in _YAML.items():
        yield "launch.yaml", name, {"q/launch/b.launch.yaml": f"{text}launch:\n- arg: {{name: a, default: *last}}\n"}
        yield "parameters", name, {"q/config/p.yaml": f"{text}b:\n  ros__parameters: {{c: *last}}\n"}
        yield "colcon", name, {"q/colcon.pkg": f"{text}dependencies: *last\n"}
        yield "repositories", name, {"a.repos": f"{text}repositories: *last\n"}
        yield "robots", f"RViz: {name}", {"q/rviz/a.rviz": f"{text}Panels: *last\n"}
    yield from (("c++", name, {"q/src/n.cpp": text}) for name, text in _SOURCES.items())
    yield from (("ignore files", name, {".gitignore": f"{text}\n", **_OWN_FILES}) for name, text in _PATTERNS.items())
    yield from (("settings", name, {"ros-lint.toml": text}) for name, text in _SETTINGS.items())
    yield from ((BASELINE, name, {"known.json": text}) for name, text in _BASELINES.items())
    yield from ((WHOLE, name, files) for name, files in _TREES.items())


_MANIFESTS: Final = {
    "entity bomb": _BOMB + "<package><name>&a12;</name></package>",
    "external entity": "<!DOCTYPE p [<!ENTITY x SYSTEM 'file:///etc/passwd'>]><package><name>&x;</name></package>",
    "parameter entity": "<!DOCTYPE p [<!ENTITY % x SYSTEM '/dev/zero'> %x;]><package><name>a</name></package>",
    "attribute defaults": "<!DOCTYPE p [<!ATTLIST package " + "a CDATA 'b' " * 5_000 + ">]><package format='3'/>",
    "attributes": _manifest(f"  <depend {' '.join(f'a{n}=' + chr(39) * 2 for n in range(5_000))}>b</depend>\n"),
    "conditions": _manifest(f'  <depend condition="{"(" * DEEP}$A == 1{")" * DEEP}">b</depend>\n'),
    "long conditions": _manifest(f'  <depend condition="{"$A == 1 and " * DEEP}$A == 1">b</depend>\n'),
    "versions": _manifest(f'  <depend version_gte="{"9" * 10_000}" version_lt="{"1." * 10_000}">b</depend>\n'),
    "names": _manifest("".join(f"  <depend>a{n}</depend>\n" for n in range(5_000))),
    "one name": _manifest("  <depend>rclcpp</depend>\n" * 5_000),
    "exports": _MANIFEST.replace("<build_type>", "<build_type condition='$A == 1'>a</build_type>" * 2_000 + "<build_type>"),
    "encoding": "<?xml version='1.0' encoding='utf-16'?>" + _MANIFEST,
    "unknown encoding": "<?xml version='1.0' encoding='punycode'?>" + _MANIFEST,
    "character references": _manifest(f"  <depend>{'&#x1F600;' * DEEP}</depend>\n"),
    "processing instructions": "<?a b?>" * DEEP + _MANIFEST,
    "comments": "<!-- a -->" * DEEP + _MANIFEST,
    "namespaces": _MANIFEST.replace("<package", "<package " + " ".join(f"xmlns:a{n}='b'" for n in range(2_000))),
}
_SCRIPTS: Final = {
    "macro that doubles": 'macro(m x)\n  m("${x}${x}")\nendmacro()\nm(a)',
    "macro that calls itself twice": "macro(m)\n  m()\n  m()\nendmacro()\nm()",
    "functions in a ring": "function(f)\n  g()\nendfunction()\nfunction(g)\n  f()\nendfunction()\nf()",
    "function that redefines itself": "macro(m)\n  macro(m)\n    m()\n  endmacro()\n  m()\nendmacro()\nm()",
    "include of itself": "include(CMakeLists.txt)\ninclude(${CMAKE_CURRENT_LIST_FILE})",
    "subdirectory of itself": "add_subdirectory(.)\nadd_subdirectory(./.)",
    "while": "while(TRUE)\n  set(a ${a}b)\nendwhile()",
    "while of the unknown": "while(${U})\n  list(APPEND a ${a})\nendwhile()",
    "foreach": "".join(f"foreach(i{n} RANGE 1000)\n" for n in range(8)) + "set(a ${a}x)\n" + "endforeach()\n" * 8,
    "foreach range": "foreach(i RANGE 999999999999999)\n  list(APPEND a ${i})\nendforeach()",
    "foreach step": "foreach(i RANGE 1 10 0)\nendforeach()\nforeach(i RANGE 10 1 -1)\nendforeach()",
    "foreach zip": "foreach(a b IN ZIP_LISTS c d e)\nendforeach()\nforeach(a IN ZIP_LISTS c)\nendforeach()",
    "repeat": "string(REPEAT a 999999999 b)\nstring(REPEAT ${b} 999999999 c)",
    "random": "string(RANDOM LENGTH 999999999 a)",
    "doubling": "set(a xx)\n" + 'set(a "${a}${a}")\n' * 60 + "install(FILES ${a} DESTINATION x)",
    "doubling lists": "set(a x y)\n" + "list(APPEND a ${a})\n" * 60 + "install(FILES ${a} DESTINATION x)",
    "nested variables": "set(a a)\n" + f"set(b {'${' * 5_000}a{'}' * 5_000})",
    "math": f'math(EXPR a "{"(" * DEEP}1{")" * DEEP}")\nmath(EXPR b "1 << 99999999999")\nmath(EXPR c "{"9" * 5_000} * 9")\nmath(EXPR d "1 / 0")',
    "long math": f'math(EXPR a "{"1+" * DEEP}1")\nmath(EXPR a "{"-" * DEEP}1")\nmath(EXPR a "{"~" * DEEP}1")',
    "expressions": 'if("' + "a" * 400 + '" MATCHES "(a|aa)+b")\nendif()\nif("' + "x" * 400 + '" MATCHES "x*x*x*x*y")\nendif()',
    "nested expressions": f'string(REGEX REPLACE "{"(" * 5_000}a{")" * 5_000}*" "\\\\1\\\\9" a "aaa")',
    "repeated expressions": 'string(REGEX MATCHALL "((((a*)*)*)*)*b" a "'
    + "a" * 5_000
    + '")\nstring(REGEX MATCH "[z-a]" b c)\nstring(REGEX MATCH "*" b c)',
    "classes": f'string(REGEX MATCH "[{"a-z" * DEEP}]" a b)',
    "versions": f"if({'9' * 10_000} VERSION_LESS {'1.' * 10_000}1)\nendif()\ncmake_minimum_required(VERSION {'9' * 5_000}...{'8' * 5_000})",
    "conditions": f"if({'NOT ' * DEEP}A)\nendif()\nif({'(' * DEEP}A{')' * DEEP})\nendif()\nif(A {'AND A ' * DEEP})\nendif()",
    "blocks": "if(A)\n" * DEEP + "endif()\n" * DEEP,
    "blocks without an end": "if(A)\n" * DEEP,
    "ends without a block": "endif()\n" * DEEP + "endfunction()\n" * 100,
    "else": "if(A)\n" + "else()\n" * 5_000 + "endif()",
    "elseif": "find_package(b)\nif(${b_A})\n" + "".join(f"elseif(${{b_{n}}})\nset(a {n})\n" for n in range(3_000)) + "endif()",
    "unknown conditions": "".join(f"if(${{U{n}}})\n  set(a ${{a}}{n})\nendif()\n" for n in range(3_000))
    + "install(FILES ${a} DESTINATION x)",
    "globs": "file(GLOB a [z-a])\nfile(GLOB b "
    + "*a" * 500
    + "b)\nfile(GLOB_RECURSE c "
    + "**/" * 500
    + "b)\nfile(GLOB d "
    + "{a,b}" * 500
    + ")",
    "glob of everything": "file(GLOB_RECURSE a /*)\nfile(GLOB_RECURSE b ../../../../*)\nfile(GLOB c CONFIGURE_DEPENDS ${U}/*)",
    "files": "file(READ /dev/zero a)\nfile(STRINGS /etc/passwd b)\ninclude(/dev/zero)\nfile(READ ../../../../etc/passwd c)\ninclude(${a})",
    "generator expressions": "add_executable(n $<IF:" + "$<BOOL:" * DEEP + "1" + ">" * DEEP + ",a,b>)",
    "eval": 'cmake_language(EVAL CODE "cmake_language(EVAL CODE \\"cmake_language(EVAL CODE a)\\")")\ncmake_language(CALL ${a} ${a})',
    "eval of itself": 'set(c "cmake_language(EVAL CODE \\"\\${c}\\")")\ncmake_language(EVAL CODE "${c}")',
    "defer": "cmake_language(DEFER CALL cmake_language DEFER CALL a)",
    "variable watch": "variable_watch(a m)\nset(a b)",
    "configure": "configure_file(CMakeLists.txt CMakeLists.txt)\nconfigure_file(${U} x)",
    "options": 'cmake_parse_arguments(A "' + "a;" * DEEP + '" "" "" ' + "b " * DEEP + ")",
    "arguments": "set(a " + "b " * LONG + ")",
    "targets in a ring": "".join(f"add_library(a{n} x.cpp)\ntarget_link_libraries(a{n} a{(n + 1) % 500})\n" for n in range(500)),
    "aliases in a ring": "add_library(a ALIAS b)\nadd_library(b ALIAS a)\ninstall(TARGETS a b)",
    "bracket arguments": "set(a [" + "=" * DEEP + "[a]" + "=" * DEEP + "])",
    "escapes": 'set(a "' + "\\;" * DEEP + '")\nlist(LENGTH a b)\nforeach(i ${a})\nendforeach()',
    "environment": "set(ENV{A} b)\nset(a $ENV{HOME}$CACHE{a}${ENV})",
    "numbers of lists": "list(GET a 99999999999999999999 b)\nlist(SUBLIST a -1 -1 b)\nlist(INSERT a 999 b)\nlist(GET a x b)\nstring(SUBSTRING abc 99 -5 d)",
    "time": 'string(TIMESTAMP a "%s%Y%n%")\nstring(TIMESTAMP b "%")\nstring(UUID c NAMESPACE a NAME b TYPE MD5)',
    "json": f'string(JSON a GET "{"[" * DEEP}{"]" * DEEP}" 0)\nstring(JSON b LENGTH "{{" )',
    "ASCII": "string(ASCII 0 27 999 -1 99999999999 a)\nstring(HEX a b)",
}
_SETUPS: Final = {
    "doubling": "x = [1]\n" + "x = [x, x]\n" * 60 + "y = [1]\n" + "y = [y, y]\n" * 60 + "z = x == y",
    "hash": "x = (1,)\n" + "x = (x, x)\n" * 60 + "y = {x: 1}",
    "power": "x = 9 ** 9 ** 9 ** 9",
    "shift": "x = 1 << 99999999999\ny = 'a' * 99999999999\nz = [0] * 99999999999",
    "format": "x = '%999999999d' % 1\ny = '{:999999999}'.format(1)\nz = f'{1:999999999}'",
    "format of attributes": "x = '{0.__class__.__mro__[1].__subclasses__}'.format(1)\ny = '%(a)s' % 1",
    "range": "x = list(range(99999999999))\ny = sum(range(99999999999))\nz = [0 for i in range(10 ** 12)]",
    "loop": "while True:\n    x = x + x if 'x' in globals() else 'a'",
    "recursion": "def f(x):\n    return f(x) + f(x)\ny = f(1)",
    "comprehensions": "x = [" + "[" * 50 + "a" + "".join(" for a in range(99)]" for _ in range(50)) + " for a in range(9)]",
    "generator": "def f():\n    yield from f()\nx = list(f())",
    "list of itself": "x = []\nx.append(x)\ny = str(x)\nz = x == x\nx.sort()\nw = x + x",
    "dictionary of itself": "x = {}\nx['x'] = x\ny = repr(x)\nz = {**x, **x}\nw = x == {'x': x}",
    "replace": "x = 'a' * 1000\n" + "x = x.replace('a', x)\n" * 9,
    "join": "x = ['a' * 1000] * 1000\n" + "x = [','.join(x)] * 1000\n" * 9,
    "glob": "x = glob('**/' * 500 + '*', recursive=True)\ny = glob('[z-a]')\nz = glob('/**', recursive=True)\nw = glob('\\0')",
    "walk": "for a, b, c in os.walk('/'):\n    for d in c:\n        x = open(os.path.join(a, d)).read()",
    "open": "x = open('/dev/zero').read()\ny = open('/etc/passwd').read()\nz = open('setup.py').read() * 10 ** 9\nw = open(-1)",
    "exec": "exec(open('setup.py').read())\neval('__import__(\"os\").system(\"x\")')",
    "decorators": "@a\n" * 5_000 + "def f(): pass",
    "class": "class A(type):\n    def __new__(m, *a): return A(*a)\nclass B(metaclass=A): pass",
    "match": "match x:\n" + "".join(f"    case {n}: pass\n" for n in range(3_000)),
    "elif": "if x: pass\n" + "elif y: pass\n" * 3_000,
    "try": "".join("    " * n + "try:\n" for n in range(90)) + "    " * 90 + "pass",
    "del": "x = 1\ndel x\ny = x\ndel y, (z, [w])",
    "star": "a, *b, c = range(10 ** 10)\n*d, = d",
    "walrus": "x = (y := (z := [1]))\n[w := i for i in range(9)]",
    "names": "\n".join(f"x{n} = x{n - 1}" for n in range(3_000)),
    "encodings": "x = 'a'.encode('idna')\ny = b'a'.decode('punycode')\nz = 'a'.encode('nowhere')",
    "identifiers": "ｓｅｔｕｐ(name='a')\nª = 1\nﬁ = 2",
    "surrogates": "x = '\\ud800'\nx.encode()\nprint(x)\nopen(x)\nos.path.join(x, '\\0')",
    "numbers": "x = int('9' * 10000)\ny = float('1e999')\nz = 1_0.0e-999j\nw = -0x" + "f" * 5_000,
    "slices": "x = 'abc'[::0]\ny = 'abc'[::-1][10 ** 30:]\nz = [1][True:None:-5]",
    "round": "x = round(1e308, -400)\ny = divmod(1, 0)\nz = pow(2, 10 ** 9)\nw = hash(1e999)\nv = chr(-1)",
    "sort": "x = sorted([1, 'a', None])\ny = max([])\nz = min(1)\nw = sum(['a'], [])",
    "arguments": "setup(**{}, **{'name': 1})\nsetup(name=None, packages=1, data_files='a', entry_points=[1], scripts={})",
    "entry points": "setup(entry_points={'console_scripts': ['a', '=', 'a=b', 'a=b:c', 'a = b : c [d]', 1, None, '\\0=\\n']})",
    "data files": "setup(data_files=[1, (1,), ('a',), ('a', 1), ('a', [1]), ('a', ['\\0']), 'a', ['a', ['b']]])",
}
_LAUNCHES: Final = {
    **{f"setup: {name}": text for name, text in _SETUPS.items() if "import" not in text},
    "YAML": "x = yaml.safe_load('a: b')\ny = yaml.safe_load('[' * 9000)\nz = yaml.safe_load('- ' * 9000)\nw = yaml.safe_load(1)",
    "YAML of itself": "x = yaml.safe_load('&a [*a]')\ny = yaml.safe_load('!!python/object:os.system {}')\nz = str(x)",
    "expressions": "x = PythonExpression(['(' * 9000, '1', ')' * 9000])\ny = PythonExpression(['9 ** 9 ** 9'])\nz = PythonExpression([z])",
    "configurations": "x = LaunchConfiguration(LaunchConfiguration(LaunchConfiguration('a')))\nDeclareLaunchArgument('a', default_value=x)",
    "includes of itself": "x = IncludeLaunchDescription(os.path.join(os.path.dirname(__file__), 'a.launch.py'))",
    "groups": "x = []\n" + "x = GroupAction([x, x])\n" * 60,
    "functions": "def f(context):\n    return [OpaqueFunction(function=f), OpaqueFunction(function=f)]\nx = OpaqueFunction(function=f)",
    "events": "x = RegisterEventHandler(OnProcessExit(on_exit=[x, x]))\n" * 100,
    "wrong arguments": "x = Node(1, 2, 3, package=None, executable=[1, None], parameters=5, remappings=[(1,)], arguments={})",
}
_XML: Final = {
    "entity bomb": _BOMB + "<launch><node pkg='&a12;' exec='a'/></launch>",
    "groups": "<launch>" + "<group>" * DEEP + "</group>" * DEEP + "</launch>",
    "substitutions": "<launch><arg name='a' default='" + "$(eval " * 3_000 + "1" + ")" * 3_000 + "'/></launch>",
    "expressions": "<launch><arg name='a' default=\"$(eval '9 ** 9 ** 9')\"/><arg name='b' default=\"$(eval '"
    + "(" * 9_000
    + "')\"/></launch>",
    "arguments in a ring": "<launch><arg name='a' default='$(var b)'/><arg name='b' default='$(var a)'/></launch>",
    "include of itself": "<launch><include file='$(dirname)/a.launch.xml'/><include file='$(dirname)/a.launch.xml'/></launch>",
    "parameters": "<launch><node pkg='q' exec='n'><param name='a' value='" + "[" * 9_000 + "'/></node></launch>",
    "parameters of parameters": "<launch><node pkg='q' exec='n'>"
    + "<param name='a'>" * 3_000
    + "</param>" * 3_000
    + "</node></launch>",
    "wrong tags": "<launch><node/><include/><arg/><let/><group if=''/><param/><set_env/><executable cmd=''/><node_container/></launch>",
    "another root": "<nodes><launch/></nodes>",
    "doubling": "<launch>" + "".join(f"<let name='a{n + 1}' value='$(var a{n})$(var a{n})'/>" for n in range(60)) + "</launch>",
}
_YAML: Final = {
    "anchors": _ANCHORS + "last: &last *a40\n",
    "a list of itself": "last: &last [*last]\n",
    "a mapping of itself": "last: &last {a: *last}\n",
    "a key of itself": "last: &last {*last : 1}\n",
    "merge keys": "a0: &a0 {x: 1}\n"
    + "".join(f"a{n + 1}: &a{n + 1} {{<<: [*a{n}, *a{n}]}}\n" for n in range(30))
    + "last: &last *a30\n",
    "tags": "last: &last !!python/object/apply:os.system ['a']\n",
    "binary": "last: &last !!binary '" + "A" * 9_999 + "'\n",
    "times": "last: &last 2001-99-99\nb: 2001-12-14t21:59:43.10-99:99\n",
    "sexagesimal numbers": "last: &last " + "1:" * 9_999 + "1\n",
    "numbers": "last: &last 0x" + "f" * 9_999 + "\nb: 1_" + "_" * 9_999 + "\n",
    "documents": "---\n" * DEEP + "last: &last a\n",
    "directives": "%YAML 9.9\n---\nlast: &last a\n",
    "keys": "last: &last {[a]: 1, {b: c}: 2, null: 3, 1: 4, 1.5: 5, true: 6}\n",
    "the same keys": "last: &last a\n" + "b: 1\n" * DEEP,
}
_SOURCES: Final = {
    "raw strings": 'auto a = R"' + "x" * DEEP + '(a)";' + 'R"(' * DEEP,
    "conditions": "#if A\n" * DEEP + "#endif\n" * DEEP,
    "includes": '#include <a>\n#include "n.cpp"\n#include "../src/n.cpp"\n' * 3_000,
    "macros": "#define A A A\n#include A\n" * 3_000,
    "templates": "a<" * DEEP + "int" + ">" * DEEP + " b;",
    "trigraphs": '??=include <a>\n%:include <b>\n#inc\\\nlude <c>\n#include/**/<d>\n_Pragma("a")\n' * 1_000,
    "comments": "/*/" * DEEP + "//\\\n" * DEEP,
    "modules": "import <a>;\nexport module a.b:c;\nimport std;\n" * 1_000,
}
_OWN_FILES: Final = {"q/config/" + "a" * 200: b"", "q/config/b/" + "/".join(["a" * 100] * 9): b""}
_PATTERNS: Final = {
    "wrong classes": "[z-a]\n[a-\\]\n[\n[]\n[!\n[^]\n[]]\n[[:alpha:]]\n[[:nowhere:]]\n[--0]\n[&&a]\n[~~]\n[||]",
    "stars": "*a" * 8 + "b\n" + "**/" * 12 + "b\n" + "**" * 999 + "\n" + "*?" * 999,
    "blanks": " " * 30_000 + "a\n" + "a" + "\\ " * 30_000,
    "patterns": "\n".join(f"a{n}/**/b*c" for n in range(9_000)),
    "everything but": "*\n!*\n" * 3_000,
    "comments": "#\n" * 99_999,
}
_SETTINGS: Final = {
    "numbers": f"jobs = {'9' * 5_000}",
    "jobs": "jobs = 1000000",
    "negative jobs": "jobs = -1",
    "infinity": "jobs = inf\n",
    "types": 'distro = [["a"]]\nselect = {a = 1}\n',
    "tool": "tool = 1\n",
    "brackets": "select = " + "[" * 100_000,
    "tables": "".join(f"[{'a.' * n}b]\n" for n in range(200)),
    "plugins": "plugins = true\nunderlay = ['/dev/zero', '/', '../../..', '\\u0000']\n",
    "output": 'output = ["/tmp/x"]\nfix = true\nwrite-baseline = true\nconfig = "/etc/passwd"\nformat = "html"\n',
    "baseline": 'baseline = "/dev/zero"\n',
    "baseline that is a folder": 'baseline = "."\n',
    "patterns": 'exclude = ["' + "*a" * 999 + 'b", "[z-a]", "\\u0000", "\\u202e"]\n',
    "severity": "[severity]\n" + "".join(f"a{n} = 'error'\n" for n in range(5_000)),
    "per path": "[per-path-ignores]\n" + "".join(f"'**/a{n}*' = ['all']\n" for n in range(5_000)),
    "URL": "rule-url = '" + "{rule}{x}{0}{" * 999 + "'\n",
    "distro": 'distro = "\\u001b[31m"\n',
    "distros": "distro = [" + "'jazzy', 'humble', 'nowhere', " * 300 + "]\n",
    "keys": "".join(f"a{n} = 1\n" for n in range(5_000)),
    "empty lines": "\n" * 100_000,
    "bytes": "a = '\udcff'\n",
}
_BASELINES: Final = {
    "brackets": "[" * 100_000,
    "infinity": '{"folders": [], "known": [{"rule": "a", "package": "b", "subject": "c", "count": 1e999, "sure": true}]}',
    "digits": '{"folders": [], "known": [{"rule": "a", "package": "b", "subject": "c", "count": ' + "9" * 9_999 + "}]}",
    "NaN": '{"folders": NaN, "known": -Infinity}',
    "types": '{"folders": {"a": 1}, "known": [[1], null, "a", {"rule": []}]}',
    "surrogates": '{"folders": ["\\ud800"], "known": [{"rule": "\\ud800", "package": "", "subject": "\\udfff", "count": 1, "sure": 1}]}',
    "entries": '{"folders": [], "known": ['
    + ", ".join(['{"rule": "a", "package": "b", "subject": "c", "count": 1, "sure": true}'] * 9_999)
    + "]}",
    "empty": "",
    "null": "null",
}
_TREES: Final[Mapping[str, Files]] = {
    "deep folders": {"d/" * 900 + "package.xml": _MANIFEST.encode()},
    "a link to itself": {"q/a": Other("link", b"a"), "q/b": Other("link", b"."), "q/c": Other("link", b"..")},
    "links to folders above": {f"q/{n}/up": Other("link", b"../..") for n in range(20)},
    "links out": {
        "q/config/a.yaml": Other("link", b"/etc/passwd"),
        "q/launch": Other("link", b"/usr"),
        "q/x": Other("link", b"/"),
    },
    "devices": {"q/src/z.cpp": Other("link", b"/dev/zero"), "q/package.xml": Other("link", b"/dev/zero")},
    "pipes": {
        "q/launch/p.launch.py": Other("fifo"),
        "q/.gitignore": Other("fifo"),
        "x.repos": Other("fifo"),
        "q/setup.py": Other("fifo"),
    },
    "sockets": {"q/launch/p.launch.py": Other("socket"), ".gitignore": Other("socket"), "q/colcon.pkg": Other("socket")},
    "folders in place of files": {
        name: Other("folder")
        for name in ("q/setup.py", ".gitignore", "a.repos", "q/colcon.pkg", "ros-lint.toml", "q/launch/a.launch.py")
    },
    "names": {
        f"q/launch/{name}.launch.py": b"x = "
        for name in ("a\nb", "a\x1b[31m", "a\u202eb", "\udcff", " ", "'", "$(a)", "::error::")
    },
    "many files": {f"q/config/{n}.yaml": b"" for n in range(3_000)},
    "many packages": {f"p{n}/package.xml": _MANIFEST.replace(">q<", f">p{n}<").encode() for n in range(300)},
    "one name": {f"p{n}/package.xml": _MANIFEST.encode() for n in range(200)},
    "a chain": {
        f"p{n}/package.xml": _MANIFEST.replace(">q<", f">p{n}<").replace("rclcpp", f"p{n + 1}").encode() for n in range(300)
    },
    "a ring": {
        f"p{n}/package.xml": _MANIFEST.replace(">q<", f">p{n}<").replace("rclcpp", f"p{(n + 1) % 100}").encode()
        for n in range(100)
    },
    "all with all": {
        f"p{n}/package.xml": _MANIFEST.replace(">q<", f">p{n}<")
        .replace("<depend>rclcpp</depend>", "".join(f"<depend>p{m}</depend>" for m in range(60)))
        .encode()
        for n in range(60)
    },
    "a chain of launch files": {
        f"q/launch/a{n}.launch.xml": f'<launch><include file="$(dirname)/a{n + 1}.launch.xml"/></launch>'.encode()
        for n in range(1_500)
    },
    "packages in packages": {"n/" * n + "package.xml": _MANIFEST.replace(">q<", f">p{n}<").encode() for n in range(1, 100)},
    "long names": {
        "q/" + "a" * 255: b"",
        "q/launch/" + "b" * 240 + ".launch.xml": b"<launch/>",
        "q/" + "c" * 200 + "/" + "d" * 200: b"",
    },
}


def _frame() -> dict[str, bytes]:
    return {path: text.encode() for path, text in {**_PACKAGE, **_PYTHON, "ros-lint.toml": 'baseline = "known.json"\n'}.items()}


def seeds() -> Iterator[tuple[str, str, Files]]:
    """Yield the target, the name and the workspace of each hostile seed."""
    for target, (path, comment, put) in _FORMATS.items():
        for name, value in _VALUES.items():
            yield target, name, {**_base(path), path: _encoded(put(value))}
        if comment:
            yield target, "a comment", {**_base(path), path: _encoded(f"{comment} {'a' * LONG}\n{comment * DEEP}\n")}
        yield target, "empty", {**_base(path), path: b""}
        yield target, "bytes", {**_base(path), path: bytes(range(256)) * 50}
        yield target, "UTF-16", {**_base(path), path: put("a").encode("utf-16")}
    for target, name, files in _own():
        path = next(iter(files))
        yield (
            target,
            f"own: {name}",
            {**_base(path), **{key: _encoded(text) if isinstance(text, str) else text for key, text in files.items()}},
        )


def _base(path: str) -> dict[str, bytes]:
    frame = _frame()
    if path == "known.json":
        return frame
    return {name: content for name, content in frame.items() if name != "ros-lint.toml"}


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")
