"""The YAML files of generate_parameter_library in a package, and the sources whose nodes get their parameters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from posixpath import normpath
from typing import NamedTuple

from ros_lint.analysis.build.commands import evaluated_name
from ros_lint.analysis.memo import cached_by_package
from ros_lint.base.paths import join, parent
from ros_lint.workspace.model import Package, Workspace

_PACKAGES = frozenset({"generate_parameter_library", "generate_parameter_library_py"})
_SUFFIXES = (".yaml", ".yml")


class DescribedParameters(NamedTuple):
    """The files that describe parameters of the nodes in a package."""

    known: bool
    """False if a file that describes parameters cannot be read."""
    by_source: Mapping[str, tuple[str, ...]]
    """The files by the sources of the targets that link to their libraries. All paths are relative to the package."""
    of_python: tuple[str, ...]
    """The file from which a Python module is generated, () if there are several."""

    def of_sources(self, sources: Iterable[str]) -> list[str]:
        """Return the files that describe the parameters of a program, which has these sources."""
        of_each = [self.of_python if source.endswith(".py") else self.by_source.get(source, ()) for source in sources]
        return [file for files in of_each for file in files]


@cached_by_package
def described_parameters(package: Package, _: Workspace) -> DescribedParameters:
    """Return the files of generate_parameter_library in a package: those that its build script names, else all in its format."""
    files = {path for code in package.node_code if (path := package.relative(code.path)).endswith(_SUFFIXES)}
    libraries: dict[str, str] = {}
    modules: list[str] = []
    for call in package.calls("generate_parameter_library", "generate_parameter_module", anywhere=True):
        name, yaml = (evaluated_name(package, text) for text in (*call.texts, "", "")[:2])
        file = normpath(join(parent(package.relative(call.path)), yaml)) if yaml else ""
        if call.name == "generate_parameter_module":
            modules.append(file)
        elif name:
            libraries[name] = file
    named = {*libraries.values(), *modules}
    uses = any(package.declared.named(name) for name in _PACKAGES)
    by_source: dict[str, tuple[str, ...]] = {}
    for target in package.built.products.targets:
        own = tuple(dict.fromkeys(libraries[name] for name, _ in target.links if name in libraries))
        for source in target.sources if own else ():
            by_source[source] = (*by_source.get(source, ()), *own)
    of_python = tuple(modules or sorted(files - named))
    return DescribedParameters(named <= files and not (uses and not files), by_source, of_python if len(of_python) == 1 else ())
