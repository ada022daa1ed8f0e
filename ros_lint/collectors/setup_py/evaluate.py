"""Evaluation of the ``setup.py``, ``setup.cfg`` and ``pyproject.toml`` of a Python package.

colcon runs setup.py, but ros-lint runs nothing: a small interpreter evaluates setup.py with the names of the files of
the package. An unknown value becomes an Opaque: a place that could not be evaluated, with the parts of the package that may
contain more than is known.
"""

from __future__ import annotations

import ast
import posixpath
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING

from ros_lint.base.paths import join
from ros_lint.base.text import Span, file_start
from ros_lint.collectors.python.import_tree import walk
from ros_lint.collectors.python.interpreter.values import LibraryName, Value
from ros_lint.collectors.python.source_errors import NotPythonError
from ros_lint.collectors.python.syntax import is_of_others, read, refusal, span_of
from ros_lint.collectors.python.unbound_names import tried, unbound
from ros_lint.collectors.setup_py import setup_cfg as setup_cfg_collector
from ros_lint.collectors.setup_py.distribution import INSTALLED, Distribution, SetupContext
from ros_lint.collectors.setup_py.interpreter.files import Files
from ros_lint.collectors.setup_py.interpreter.library import Setup
from ros_lint.collectors.setup_py.interpreter.program import Program
from ros_lint.collectors.setup_py.options import completed
from ros_lint.facts.build import BuildProject, BuildScript, SetupScript
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Facet, Opaque, Problem

if TYPE_CHECKING:
    from ros_lint.base.text import Text
    from ros_lint.collectors.setup_py.setup_cfg import SetupCfg

_PLAIN_SETUPS = frozenset({"setuptools", "distutils", "distutils.core"})


def evaluate(
    name: str,
    path_prefix: str,
    files: Sequence[str],
    setup_py: Text | None,
    setup_cfg: Text | None,
    pyproject: Text | None,
    executables: AbstractSet[str] = frozenset(),
) -> BuildScript:
    """Return the build script of a Python package: the files that setuptools installs, and the problems of the build.

    - ``name``: the name in package.xml.
    - ``path_prefix``: the folder of the package.
    - ``files``: all files below the folder of the package, relative to it.
    - ``executables``: the files with the executable bit.

    Problems have the kinds ``syntax``, ``missing-file``, ``directory-in-data-files``, ``empty-glob``, ``data-files-form``,
    ``absolute-destination``, ``entry-point-form``, ``undefined-name``, ``no-function``, and the kinds of
    :mod:`ros_lint.collectors.setup_py.setup_cfg`.
    """
    first = setup_py or setup_cfg or pyproject
    start = file_start(first.path if first else join(path_prefix, "setup.py"))
    cfg = setup_cfg_collector.collect(setup_cfg) if setup_cfg else None
    package_files = Files(files)
    program = Program(name, package_files)
    library = program.setup_library
    if setup_py is None:
        script = BuildScript(start.path)
        library.setups.append(Setup({}, None, "setuptools"))
    else:
        script = _run(program, setup_py, start)
    place = _placer(setup_py)
    folder, unknown_folder = _scripts_folder(cfg)
    found = [unknown_folder] if unknown_folder else []
    for setup in library.setups:
        call = place(setup, start)
        options = completed(setup.options, package_files, cfg, pyproject)
        context = SetupContext(package_files, executables, folder, call, len(library.setups) > 1)
        distribution = Distribution(context, place)
        distribution.read(options)
        if setup.module not in _PLAIN_SETUPS:
            reason = f"setup() of {setup.module} may install more than its arguments say"
            found.append(Opaque(INSTALLED | Facet.LIBRARIES, reason, call))
        script = _with(script, distribution, options, place, call)
    modules = tuple(sorted({*script.products.python_packages, *library.generated}))
    return script._replace(
        products=script.products._replace(python_packages=modules),
        opaque=tuple(dict.fromkeys([*script.opaque, *found])),
        problems=tuple(dict.fromkeys([*script.problems, *(cfg.problems if cfg else ())])),
        python=script.python._replace(editable_texts=cfg.texts if cfg else ()),
    )


def _run(program: Program, source: Text, start: Span) -> BuildScript:
    """Interpret a setup.py, and return a build script with its imports and problems.

    If setup.py cannot be evaluated to its end or does not call setup(), the build script has an Opaque (a place that could not
    be evaluated) with the span ``start``.
    """
    script = BuildScript(source.path)
    try:
        tree, newer = read(source)
    except NotPythonError as error:
        if is_of_others(source):
            reason = "the source is not valid Python 3: it is a template or Python 2"
            return script._replace(opaque=(Opaque(INSTALLED, reason, start),))
        why = refusal(source, error)
        return script._replace(opaque=(why.opaque(INSTALLED),), problems=(why.problem(),) if why.known else ())
    program.follow(tree, source)
    imports = [item for item in walk(source, tree) if item.module != "__future__"]
    spans = source.spans([(item.start, item.start + len(item.module)) for item in imports])
    script = script._replace(
        mentions=tuple(
            Mention(item.module, "import", span, f"import of {item.module}", item.optional)
            for item, span in zip(imports, spans, strict=True)
        )
    )
    script = script._replace(
        problems=tuple(_failing(program, tree, source)),
        python=SetupScript(newer_syntax=() if newer and is_of_others(source) else newer),
    )
    if program.end or not program.setup_library.setups:
        reason = f"setup.py cannot be evaluated to its end: {program.end}" if program.end else "it contains no call of setup()"
        return script._replace(opaque=(Opaque(INSTALLED, reason, start),))
    return script


def _failing(program: Program, tree: ast.Module, source: Text) -> Iterator[Problem]:
    """Yield the errors that stop setup.py: undefined names, and calls of values that are no functions.

    Errors that a try statement catches are omitted.
    """
    for name in unbound(tree, (name for name, _ in program.unbound)):
        yield Problem("undefined-name", f"'{name.id}' is not defined; define or import it", span_of(source, name))
    if not program.no_functions:
        return
    caught = {node for statement in ast.walk(tree) if isinstance(statement, ast.Try) for node in tried(statement)}
    for call, value in program.no_functions:
        if call not in caught:
            yield Problem("no-function", _no_function(value), span_of(source, call.func))


def _no_function(value: Value) -> str:
    if isinstance(value, LibraryName):
        inside = f"; write {value.name}.{value.name}()" if value.name == "glob" else ""
        return f"'{value.name}' is a module and cannot be called{inside}"
    kind = "text" if isinstance(value, str) else type(value).__name__
    return f"this {kind} cannot be called; is a comma missing after it?"


def _placer(setup_py: Text | None) -> Callable[[Value, Span], Span]:
    """Return a function ``place(value, default)`` that returns the span of a value, ``default`` if the value has no span."""

    def place(value: Value, default: Span) -> Span:
        node = getattr(value, "node", None)
        if isinstance(node, Span):
            return node
        if setup_py is not None and isinstance(node, (ast.expr, ast.stmt)):
            return span_of(setup_py, node)
        if isinstance(value, (tuple, list)) and value:
            return place(value[0], default)
        return default

    return place


def _scripts_folder(cfg: SetupCfg | None) -> tuple[str | None, Opaque | None]:
    """Return a pair: the install folder of programs relative to the prefix, and None.

    If the folder is unknown, the pair is None and an Opaque, that is, a place that could not be evaluated. The option
    install_scripts in the section [install] of setup.cfg sets the folder; the default is bin.
    """
    option = cfg.section("install").get("install_scripts") if cfg else None
    if option is None:
        return "bin", None
    match = _BASE.match(option.value)
    if match and "$" not in match[1]:
        return posixpath.normpath(match[1]), None
    reason = f"the value '{option.value}' of install_scripts in setup.cfg cannot be evaluated"
    return None, Opaque(Facet.EXECUTABLES, reason, option.span)


_BASE = re.compile(r"\$\{?(?:base|prefix)\}?/(.*)\Z")


def _with(
    script: BuildScript,
    distribution: Distribution,
    options: Mapping[str, Value],
    place: Callable[[Value, Span], Span],
    call: Span,
) -> BuildScript:
    """Return ``script`` with the files, entry points and problems of one call of setup() added."""
    name, version = options.get("name"), options.get("version")
    return script._replace(
        project=BuildProject(
            name=str(name) if isinstance(name, str) else "",
            name_span=place(name, call) if isinstance(name, str) else None,
            version=str(version) if isinstance(version, str) else "",
            version_span=place(version, call) if isinstance(version, str) else None,
        ),
        products=script.products._replace(
            installs=(*script.products.installs, *distribution.provides),
            entry_points=(*script.products.entry_points, *distribution.entry_points),
            python_packages=(*script.products.python_packages, *distribution.python_packages),
        ),
        python=script.python._replace(relocated_modules=(*script.python.relocated_modules, *distribution.moved)),
        opaque=(*script.opaque, *distribution.opaque),
        problems=(*script.problems, *distribution.problems),
    )
