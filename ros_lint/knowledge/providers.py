"""Resolve a header, a Python module, a CMake package or a wrong name to names that can be declared.

The order of look-ups is always: workspace, underlays, index of the distribution, name maps.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal, NamedTuple, Protocol

from ros_lint.base.auxiliary_files import is_auxiliary
from ros_lint.knowledge.names import NOTHING_NEEDED

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ros_lint.facts.build import BuildScript
    from ros_lint.knowledge import Knowledge
    from ros_lint.knowledge.provides import Known
    from ros_lint.knowledge.spelling import Spelling
    from ros_lint.knowledge.underlays import Underlay


Layer = Literal["workspace", "underlay", "index"]
"""Origin of a package: the topmost layer that contains it."""


class Providers(NamedTuple):
    """The providers of a header, a module or a CMake package.

    The declaration of any one of ``names`` satisfies the use.
    """

    names: tuple[str, ...] = ()
    """Packages and keys; the first is the one to declare."""
    packages: tuple[str, ...] = ()
    """The members of ``names`` that are packages."""
    keys: tuple[str, ...] = ()
    """The members of ``names`` that are rosdep keys."""
    none_needed: bool = False
    """True if the language or the build tool provides it."""
    sure: bool = True
    """False if most released packages that use it declare none of the names, or if too few use it."""

    @property
    def known(self) -> bool:
        """True if there is a provider or none is needed. Otherwise a rule reports nothing."""
        return bool(self.names) or self.none_needed


class Suggestion(NamedTuple):
    """The intended name of an unknown name."""

    name: str
    """A package, or a rosdep key that resolves for the distribution."""
    by: Literal["spelling", "cmake", "header", "python", "system", "slip"]
    """Kind of the mistake.

    * "spelling": dashes, capitals, or the name of something in the package.
    * "cmake", "header", "python": the name in find_package(), #include or import.
    * "system": the name in apt or pip.
    * "slip": one letter.
    """


class Layers(Protocol):
    """The look-ups that name resolution needs; :class:`ros_lint.knowledge.world.World` implements them."""

    @property
    def knowledge(self) -> Knowledge:
        """Data about released packages."""

    @property
    def underlays(self) -> Sequence[Underlay]:
        """Underlays, the topmost first."""

    @property
    def spelling(self) -> Spelling:
        """Index of similar names."""

    def layer(self, name: str) -> Layer | None:
        """Return the topmost layer that contains a package, None if there is none."""

    def is_package(self, name: str) -> bool:
        """Return whether any layer contains a package."""

    def is_key(self, name: str) -> bool:
        """Return whether a name is a rosdep key."""

    def offering(self, module: str) -> tuple[str, ...]:
        """Return the packages of the workspace with a Python module."""

    def python_modules(self, name: str) -> Known:
        """Return the top-level Python modules of a package."""

    def by_cmake(self, name: str) -> Providers:
        """Return the providers of the argument of find_package()."""

    def by_folder(self, folder: str) -> Providers:
        """Return the providers of headers below an include folder."""

    def meant(self, name: str, *, python: bool) -> Suggestion | None:
        """Return the intended name of an unknown name, None if there is any doubt."""


_NONE_NEEDED = Providers(none_needed=True)

_RELEASED = re.compile(r"ros-[a-z]+-(?=[a-z])")
"""Prefix of the apt packages of a distribution."""


def by_cmake(world: Layers, name: str) -> Providers:
    """Return the providers of the argument of find_package()."""
    owners = _in_underlay(world, [underlay.cmake(name) for underlay in world.underlays])
    if world.layer(name) == "workspace":
        return _of(world, (name,))
    mapped = world.knowledge.names.cmake(name)
    if mapped == (NOTHING_NEEDED,) and not owners:
        return _NONE_NEEDED
    found = _of(world, (*owners, name, *mapped), keys=mapped)
    if not found.known or owners or found.names[0] == name:
        return found
    return found._replace(sure=world.knowledge.names.cmake_sure(name))


def by_macro(world: Layers, package: str) -> Providers:
    """Return the providers of a package's macros."""
    names = world.knowledge.names.alternatives(package)
    return world.by_cmake(package) if len(names) == 1 else _of(world, names, keys=names)


def by_include(world: Layers, header: str) -> Providers:
    """Return the providers of a header."""
    names = world.knowledge.names
    first, slash, rest = header.partition("/")
    if slash and not world.underlays and not names.maps(first):
        return world.by_folder(first)
    shared = names.shares(first)
    second = f"{first}_{rest.partition('/')[0]}" if shared and "/" in rest else ""
    mapped = names.header(header)
    if slash and not shared and world.layer(first) == "workspace":
        return _of(world, (first,))
    if second and world.layer(second) == "workspace":
        return _of(world, (second,))
    owners = _in_underlay(world, [underlay.headers(header) for underlay in world.underlays])
    if mapped == (NOTHING_NEEDED,):
        return _NONE_NEEDED
    by_folder = second if shared else first if slash else ""
    found = _of(world, (*owners, *((by_folder,) if world.is_package(by_folder) else ()), *mapped), keys=mapped)
    if not found.known:
        return found
    by_map = found.names[0] in found.keys or (found.names[0] != by_folder and not owners)
    return found._replace(sure=names.header_sure(header)) if by_map else found


def by_folder(world: Layers, folder: str) -> Providers:
    """Return the providers of headers below a folder whose name identifies the package."""
    return _of(world, (folder,))


def by_import(world: Layers, module: str) -> Providers:
    """Return the providers of a Python module."""
    names = world.knowledge.names
    top = module.partition(".")[0]
    keys = names.module(module)
    if keys == (NOTHING_NEEDED,):
        return _NONE_NEEDED
    offering = world.offering(top)
    if offering:
        return _of(world, _with_released(world, top, offering))
    owners = _in_underlay(world, [underlay.modules(top) for underlay in world.underlays])
    differing = names.module_packages(module, world.knowledge.distro)
    named = () if any(world.is_package(name) for name in differing) or not _has_module(world, top) else (top,)
    return _of(world, (*owners, *differing, *named, *keys), keys=keys)


def _with_released(world: Layers, module: str, offering: tuple[str, ...]) -> tuple[str, ...]:
    """Return the workspace packages with a module, and the released package of the same name, if any."""
    if module in offering or world.layer(module) == "workspace":
        return offering
    answer = world.python_modules(module).ask(module) if world.is_package(module) else "missing"
    return (module, *offering) if answer == "exists" else offering if answer == "missing" else (*offering, module)


def offered(script: BuildScript, files: Sequence[str]) -> tuple[str, ...] | None:
    """Return the top-level importable modules that a package installs, None if unknown.

    ``files`` are the files of the package. ``find_namespace_packages()`` lists all folders as packages, so folders
    without Python modules and folders with names of data are left out.
    """
    tops = dict.fromkeys(name.partition(".")[0] for name in script.products.python_packages)
    modules: dict[str, bool] = {}
    for file in files if tops else ():
        top, slash, rest = file.removeprefix("src/").partition("/")
        if slash and top in tops:
            is_module = rest == "__init__.py" or (rest.endswith(".py") and top not in _DATA)
            modules[top] = modules.get(top, False) or is_module
    found = tuple(dict.fromkeys([*(top for top in tops if modules.get(top, True)), *_installed_modules(script)]))
    return found if found or _has_no_module(script, files) else None


def _installed_modules(script: BuildScript) -> Iterator[str]:
    """Yield the modules whose files are installed directly into a folder of ``sys.path``."""
    for provided in script.products.installs:
        if provided.path.endswith(".py") and provided.importable:
            top = provided.path.partition("-packages/")[2].partition("/")[0].removesuffix(".py")
            if top != "__init__":
                yield top


def _has_no_module(script: BuildScript, files: Iterable[str]) -> bool:
    """Return whether a package certainly has no module.

    No file becomes a module, and CMake finds no tool for bindings.
    """
    if any(mention.name.lower().startswith(_BINDS) for mention in script.mentions if mention.via == "cmake"):
        return False
    return not any(file.endswith(_MODULES) and not (is_auxiliary(file) or ".launch." in file) for file in files)


_BINDS = ("python", "pybind11", "nanobind", "swig")
_MODULES = (".py", ".pyx", ".i", ".idl", ".msg", ".srv", ".action")


_DATA = frozenset(
    {
        "launch", "config", "configs", "cfg", "params", "param", "resource", "resources", "urdf", "meshes", "models", "worlds",
        "world", "maps", "map", "rviz", "scenarios", "test", "tests", "doc", "docs", "examples", "images", "scripts", "include",
        "msg", "srv", "action", "build", "install", "log",
    }
)  # fmt: skip
"""Names of folders that usually contain no modules."""


def meant(world: Layers, name: str, *, python: bool) -> Suggestion | None:
    """Return the intended name of an unknown name, None if there is any doubt.

    With ``python`` the name is needed to run Python code, so names of find_package() do not count.
    """
    names = world.knowledge.names
    package = name.replace(".", "/").partition("/")[0]
    if package != name and world.is_package(package):  # an interface or a module: std_msgs/msg/String, rclpy.qos
        return Suggestion(package, "spelling")
    released = _RELEASED.match(name)
    package = name[released.end() :].replace("-", "_") if released else ""
    if package and world.is_package(package):  # ros-humble-tf2-ros
        return Suggestion(package, "system")
    libraries = () if python else tuple(_libraries(names.cmake(name)))
    if libraries:
        return _first(world, libraries, "cmake")  # a build uses no pip packages
    same = _declarable(world, world.spelling.same(name))
    if same:
        return Suggestion(same[0], "spelling") if len(same) == 1 else None
    for found in _other_names(world, name, python=python):
        if found is not None:
            return found
    slips = _declarable(world, world.spelling.one_slip(name))
    if python:  # Python does not use C libraries directly: the key for pyaml is that of the module, not of libyaml
        slips = _declarable(world, (slip if world.is_package(slip) else f"python3-{slip}" for slip in _bare(slips)))
    return Suggestion(slips[0], "slip") if len(slips) == 1 else None


def _bare(names: Iterable[str]) -> Iterator[str]:
    return (name.removeprefix("python3-") for name in names)


def near(world: Layers, name: str, *, python: bool) -> tuple[str, ...]:
    """Return packages and keys similar to an unknown name, nearest first, at most three."""
    sure = world.meant(name, python=python)
    found = _declarable(world, world.spelling.near(name))
    return tuple(dict.fromkeys([sure.name, *found] if sure else found))[:3]


def _other_names(world: Layers, name: str, *, python: bool) -> Iterator[Suggestion | None]:
    """Yield the meaning of the name in other name spaces: CMake packages, modules, apt, pip."""
    names, rosdep = world.knowledge.names, world.knowledge.rosdep
    bare = name.removeprefix("python3-").removeprefix("python-").removesuffix("-pip").removesuffix("-python")
    if python or bare != name:
        yield _first(world, [f"python3-{bare}", f"python3-{bare}-pip"], "spelling")
        yield _first(world, (*names.module_packages(bare, world.knowledge.distro), *names.module(bare)), "python")
        yield _only(world, rosdep.installing(bare))
        yield _first(world, [f"python3-{bare.removeprefix('py')}"], "spelling")  # pyserial
    else:
        yield _first(world, _libraries(names.cmake_any_case(name)), "cmake")
        yield _first(world, names.folder(name), "header")
    yield _only(world, rosdep.installing(name))


def _libraries(names: Iterable[str]) -> Iterator[str]:
    """Yield the names without packages that only locate a library for CMake: the library is intended."""
    return (name for name in names if name != NOTHING_NEEDED and not name.endswith("_cmake_module"))


def _first(world: Layers, names: Iterable[str], by: Literal["spelling", "cmake", "header", "python"]) -> Suggestion | None:
    found = _declarable(world, names)
    return Suggestion(found[0], by) if found else None


def _only(world: Layers, keys: Iterable[str]) -> Suggestion | None:
    found = _declarable(world, keys)
    return Suggestion(found[0], "system") if len(found) == 1 else None


def _declarable(world: Layers, names: Iterable[str]) -> tuple[str, ...]:
    """Return the names that a manifest may declare: packages, and keys with a rule for the distribution."""
    resolves = world.knowledge.resolves
    return tuple(name for name in names if world.is_package(name) or (world.is_key(name) and resolves(name) is not False))


def _has_module(world: Layers, package: str) -> bool:
    """Return whether a package may provide the module of its name: it is not known to lack it."""
    if world.layer(package) == "workspace":
        return False  # the build script has been consulted already
    return world.is_package(package) and world.python_modules(package).ask(package) != "missing"


def _in_underlay(world: Layers, owners: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    """Return the owners in the topmost underlay that has any, without packages hidden by the workspace."""
    for found in owners:
        seen = tuple(name for name in found if world.layer(name) == "underlay")
        if seen:
            return seen
    return ()


def _of(world: Layers, names: Iterable[str], keys: Iterable[str] = ()) -> Providers:
    """Return the providers among names: existing packages, and rosdep keys among ``keys``.

    Keys without a rule for the distribution come last, because a declared name must resolve.
    """
    ordered = dict.fromkeys(name for name in names if name != NOTHING_NEEDED)
    allowed = set(keys)
    packages = tuple(name for name in ordered if world.is_package(name))
    as_keys = tuple(name for name in ordered if name in allowed and name not in packages and world.is_key(name))
    found = [name for name in ordered if name in packages or name in as_keys]
    if as_keys and len(found) > 1:
        found.sort(key=lambda name: name in as_keys and world.knowledge.resolves(name) is False)
    return Providers(tuple(found), packages, as_keys)
