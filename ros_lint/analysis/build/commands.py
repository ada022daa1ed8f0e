"""What several rules about building and installing ask of a package's build script."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from ros_lint.base.auxiliary_files import is_apart
from ros_lint.base.text import Span, beginning
from ros_lint.base.tree import join, within
from ros_lint.collectors.cmake.released_macros import INSTALL_ARTIFACTS, INSTALL_TARGETS_WORDS
from ros_lint.collectors.suffixes import HEADERS
from ros_lint.facts.build import BuildScript, Provided
from ros_lint.facts.cmake import Call, Target
from ros_lint.facts.manifest import Role
from ros_lint.facts.sources import Registration
from ros_lint.facts.visibility import Facet, Opaque
from ros_lint.workspace.model import Package

FINDS_TESTS = frozenset({
    "ament_lint_auto_find_test_dependencies", "ament_auto_find_test_dependencies", "autoware_package",
})  # fmt: skip
"""Commands that find all that is declared for tests, and with it linters, which then run."""

LINTERS = {
    f"ament_cmake_{linter}": f"ament_{linter}"
    for linter in ("clang_format", "clang_tidy", "copyright", "cppcheck", "cpplint", "flake8", "lint_cmake", "mypy", "pclint",
                   "pep257", "pycodestyle", "pyflakes", "uncrustify", "xmllint")
}  # fmt: skip
"""Linters, and the command of each."""


def top_file(package: Package) -> str:
    """Return the path of the package's own CMakeLists.txt, relative to the base."""
    return from_base(package, "CMakeLists.txt")


def called(package: Package, *names: str, anywhere: bool = False) -> Iterator[Call]:
    """Yield the calls of commands in the package's own CMakeLists.txt, or ``anywhere`` in its CMake files, in order."""
    if package.script is None:
        return
    found = [call for call in package.script.written if call.name in names]
    if anywhere or not found:
        yield from found
    else:
        top = top_file(package)
        yield from (call for call in found if call.path == top)


def is_cut_short(script: BuildScript) -> bool:
    """Whether CMake stops where a script is not to be seen: at a mistake in its syntax, a script or a folder that is not there.

    A file that is to be installed and is not there hides nothing.
    """
    return any(problem.kind in _STOPS for problem in script.problems)


_STOPS = ("cmake-syntax", "missing-folder", "missing-script")


def config_names(name: str) -> tuple[str, str]:
    """Return how the file is called that find_package() reads for a name, in both forms."""
    return f"{name}Config.cmake", f"{name.lower()}-config.cmake"


def has_extras(package: Package) -> bool:
    """Whether code of a package runs where it is found: files that ament_package(CONFIG_EXTRAS) is given, known or not."""
    if package.built.extras:
        return True
    return any("CONFIG_EXTRAS" in text for call in called(package, *ENDS, anywhere=True) for text in call.texts)


def installed_targets(call: Call) -> tuple[int, ...]:
    """Return the indexes of the arguments that are names of targets, in a call of install(TARGETS) and in no other."""
    texts = call.texts
    if texts[:1] != ("TARGETS",):
        return ()
    words = (at for at, text in enumerate(texts) if text in INSTALL_ARTIFACTS or text in INSTALL_TARGETS_WORDS)
    return tuple([at for at in range(1, next(words, len(texts))) if texts[at] != "TARGETS"])


ENDS = ("ament_package", "ament_auto_package")
"""Commands that end a package: they write down what it exports."""

REGISTERING = ("rclcpp_components_register_node", "rclcpp_components_register_nodes")
"""Commands that register components; the first argument is the library that has them."""

EXPORTING_PLUGINS = "pluginlib_export_plugin_description_file"


_OWN_TARGET = re.compile(r"[^:\s]+")
"""The name of a target that is none of another package."""


def hidden(package: Package, facet: Facet) -> tuple[Opaque, ...]:
    """Return what hides a facet, leaving out targets that are installed and that nobody defines: these are mistakes."""
    return tuple(opaque for opaque in package.hidden(facet) if not _OWN_TARGET.fullmatch(opaque.undefined))


def relative(package: Package, path: str) -> str:
    """Return a path relative to the package."""
    return within(package.path, path)


def from_base(package: Package, path: str) -> str:
    """Return a path of the package relative to the base, as places have it: the reverse of :func:`relative`."""
    return join(package.path, path)


def place_of(package: Package, path: str) -> Span:
    """Return where to point when a file of the package as a whole is meant."""
    return beginning(from_base(package, path))


_PROJECT_NAME = re.compile(r"\$\{(?:PROJECT_NAME|CMAKE_PROJECT_NAME)\}")


def evaluated_name(package: Package, text: str) -> str | None:
    """Return the name that an argument gives, None when it has variables other than that of the project's name."""
    name = _PROJECT_NAME.sub(package.script.name if package.script and package.script.name else package.name, text)
    return None if "$" in name or not name else name


def generated_from(package: Package) -> frozenset[str]:
    """Return the interface files, relative to the package, that code is generated from in every build, and installed with it."""
    script = package.built
    if package.builds_with != "ament_cmake" or "rosidl_generate_interfaces" not in script.calls:
        return frozenset()
    ends = tuple([f"/{interface}.{interface.partition('/')[0]}" for interface in script.interfaces])
    return frozenset([p.source for p in script.provides if p.source and p.path.endswith(ends) and not p.conditional])


_TEST_COMMANDS = {
    "ament_add_gtest": "ament_cmake_gtest",
    "ament_add_gmock": "ament_cmake_gmock",
    "ament_add_pytest_test": "ament_cmake_pytest",
    "ament_add_google_benchmark": "ament_cmake_google_benchmark",
    "add_launch_test": "launch_testing_ament_cmake",
    "add_ros_test": "ros_testing",
}
_FOR_TESTS = frozenset({*_TEST_COMMANDS.values(), "ament_lint_auto", "ament_lint_common"})


def unguarded_tests(package: Package) -> dict[str, Call]:
    """Return the packages for tests that are declared for tests only, or not at all, and used in every build: the first call."""
    found: dict[str, Call] = {}
    if package.builds_with != "ament_cmake":
        return found
    for call in called(package, "find_package", *_TEST_COMMANDS):
        provider = _TEST_COMMANDS.get(call.name) or (call.texts[0] if call.args else "")
        stops = call.name != "find_package" or "REQUIRED" in call.texts
        always = stops and not call.test and not call.blocks
        if always and provider in _FOR_TESTS and provider not in found and not package.declares(provider) & ~Role.TEST:
            found[provider] = call
    return found


def programs_built(script: BuildScript) -> Iterator[Target]:
    """Yield the executables that are built for use: no tests, nor what is called so."""
    for target in script.targets:
        if target.kind == "executable" and not target.test and "test" not in target.name:
            yield target


def is_on_request(package: Package, target: Target) -> bool:
    """Whether some builds leave out all that a target is made of, or it is an example."""
    wanted = bool(target.sources) and set(target.sources) == set(target.optional)
    return wanted or is_apart(relative(package, target.span.path))


def stranded(package: Package, name: str) -> bool:
    """Return whether a program that launch would not find is built, and goes to bin or nowhere: its own rules say so."""
    script = package.script
    if script is None:
        return False
    if package.builds_with == "ament_cmake":
        return any(target.name == name for target in programs_built(script))
    return any(provided.path == f"bin/{name}" for provided in script.provides)


_CLIENTS = frozenset({"rclcpp", "rclcpp_lifecycle", "rclcpp_action", "rclcpp_components"})
_RUNS = frozenset({"add_custom_command", "add_custom_target"})


def may_run_built(script: BuildScript) -> bool:
    """Whether a custom command may run in the build what the package builds.

    That which rosidl makes for interfaces does not.
    """
    calls = [call.name for call in script.written] if "rosidl_generate_interfaces" in script.calls else script.calls
    return not _RUNS.isdisjoint(calls)


def with_client(package: Package) -> frozenset[str]:
    """Return the C++ files that include a client library, relative to the package."""
    return frozenset(relative(package, use.span.path) for use in package.uses if use.via == "include" and use.package in _CLIENTS)


def node_targets(package: Package) -> frozenset[str]:
    """Return the executables of which a source, or the header that is called as a source is, includes a client library."""
    files = with_client(package)
    return frozenset(
        target.name
        for target in package.built.targets
        if target.kind == "executable" and (not files.isdisjoint(target.sources) or has_header(target, files))
    )


def has_header(target: Target, files: Iterable[str]) -> bool:
    """Whether one of some files is a header that is called as a source of a target is."""
    stems = {stem(source) for source in target.sources}
    return any(file.endswith(HEADERS) and stem(file) in stems for file in files)


def stem(path: str) -> str:
    """Return the name of a file without its folder and all that follows the first dot."""
    return path.rpartition("/")[2].partition(".")[0]


def library_calls(package: Package, name: str) -> Iterator[Call]:
    """Yield the commands that make a library of some name, in order."""
    for call in called(package, "add_library", "ament_auto_add_library", anywhere=True):
        if call.args and evaluated_name(package, call.texts[0]) == name:
            yield call


def is_shared_by_words(package: Package, name: str) -> bool:
    """Return whether every build makes a library a shared one, by the words of the command."""
    calls = library_calls(package, name)
    return any(not call.blocks and not {"SHARED", "MODULE"}.isdisjoint(call.texts) for call in calls)


def library_of(package: Package, made: Registration) -> str:
    """Return the library, tests aside, of which a source makes a class loadable; "" if there is none."""
    path = relative(package, made.span.path)
    for target in package.built.targets:
        if target.kind == "library" and not target.test and path in target.sources:
            return target.name
    return ""


def installs_built(script: BuildScript) -> bool:
    """Whether anything that a package builds may be installed, by the name of its target or as a file.

    What rosidl generates, and installs by itself, is none of it.
    """
    built = (provided.path for provided in script.provides if provided.target or provided.path.startswith(("lib/", "bin/")))
    return not all(_GENERATED in path for path in built)


_GENERATED = "__rosidl_"
"""What stands in the names of the libraries of interfaces, and of no others."""


def listed_to_install(package: Package) -> frozenset[str]:
    """Return every name among the arguments of install(): what stands there may be installed, whether or not it is seen."""
    texts = {text for call in called(package, "install", anywhere=True) for text in call.texts}
    return frozenset([name for text in texts if (name := evaluated_name(package, text))])


def astray(package: Package, endings: tuple[str, ...]) -> dict[str, Provided]:
    """Return the libraries that every build installs to the folder of the programs and to no other, with the first place.

    Of the files of a library those count that have one of some endings.
    """
    places: dict[str, list[Provided]] = {}
    for provided in package.built.provides:
        if provided.target and provided.path.endswith(endings):
            places.setdefault(provided.target, []).append(provided)
    own = f"lib/{package.name}/"
    return {
        name: found[0]
        for name, found in places.items()
        if all(each.path.startswith(own) and not (each.conditional or each.test) for each in found)
    }


def forgotten_nodes(package: Package) -> frozenset[str]:
    """Return the nodes of a package that installs nothing at all of what it builds: no tests, nothing that the build may run."""
    script = package.script
    if script is None or hidden(package, Facet.EXECUTABLES) or installs_built(script) or may_run_built(script):
        return frozenset()
    return node_targets(package).intersection(target.name for target in programs_built(script))


def left_out_nodes(package: Package) -> frozenset[str]:
    """Return the nodes of every build that a package does not install, while it installs others of its nodes.

    No tests, examples or what measures, by the name or the folder of a source, and nothing that the build may run.
    """
    script = package.script
    if script is None or hidden(package, Facet.EXECUTABLES) or may_run_built(script):
        return frozenset()
    nodes = node_targets(package)
    installed = {provided.target for provided in script.provides if provided.target}
    if nodes.isdisjoint(installed):
        return frozenset()
    left_out = nodes - installed - listed_to_install(package)
    return frozenset(
        target.name
        for target in programs_built(script)
        if target.name in left_out and not is_on_request(package, target) and not _is_aside(target)
    )


_ASIDE = re.compile(r"(?:^|_)(?:bench\w*|demo|dummy|example|mock|perf\w*|sample|try|tutorial)s?(?:_|$)|test", re.IGNORECASE)


def _is_aside(target: Target) -> bool:
    return bool(_ASIDE.search(target.name)) or any(is_apart(source) for source in target.sources)
