"""Find the packages and rosdep keys that a manifest can declare for a header, Python module, CMake package or misspelled name.

Names are looked up in this order: workspace, underlays, package index of the distribution, maps of names.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal, NamedTuple, Protocol

from ros_lint.base.auxiliary_files import is_auxiliary
from ros_lint.knowledge.builtin import replacement_key
from ros_lint.knowledge.names import NOTHING_NEEDED

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ros_lint.facts.build import BuildScript
    from ros_lint.knowledge import Knowledge
    from ros_lint.knowledge.provides import Known
    from ros_lint.knowledge.spelling import Spelling
    from ros_lint.knowledge.underlays import Underlay


Layer = Literal["workspace", "underlay", "index"]
"""The layer that contains a package. If several layers contain it, the first one counts; "index" has the released packages."""


class Providers(NamedTuple):
    """The packages and rosdep keys that provide a header, a Python module or a CMake package.

    It is enough to declare one of ``names``.
    """

    names: tuple[str, ...] = ()
    """Packages and rosdep keys, best first. A fix declares the first one."""
    packages: tuple[str, ...] = ()
    """The members of ``names`` that are packages of the workspace, an underlay or the distribution."""
    keys: tuple[str, ...] = ()
    """The members of ``names`` that are rosdep keys."""
    none_needed: bool = False
    """True if the language or the build tool provides the header, module or CMake package, so that nothing has to be declared."""
    sure: bool = True
    """False if few released packages use the header, module or CMake package, or if most of them declare none of ``names``."""

    @property
    def known(self) -> bool:
        """True if there is a provider or none is needed. If it is False, rules report nothing."""
        return bool(self.names) or self.none_needed


class Suggestion(NamedTuple):
    """The existing name that a misspelled name certainly means."""

    name: str
    """The intended name: a package, or a rosdep key that resolves in the distribution."""
    by: Literal["spelling", "cmake", "header", "python", "system", "slip"]
    """Kind of the mistake.

    * "spelling": other dashes or capitals, or the name of a message type or module of the package in place of the
      package.
    * "cmake", "header", "python": the name in find_package(), #include or import in place of the package or key.
    * "system": the name of the apt or pip package.
    * "slip": one wrong letter.
    """


class Layers(Protocol):
    """The look-ups of names that this module needs, implemented by :class:`ros_lint.knowledge.world.World`."""

    @property
    def knowledge(self) -> Knowledge:
        """Data about released packages of the distribution."""

    @property
    def underlays(self) -> Sequence[Underlay]:
        """Install prefixes below the workspace, the topmost first."""

    @property
    def spelling(self) -> Spelling:
        """Index of all names, for look-ups of similar names."""

    def layer(self, name: str) -> Layer | None:
        """Return the origin of a package; None if no layer (workspace, underlay, index) contains the package."""

    def is_package(self, name: str) -> bool:
        """Return whether the workspace, an underlay or the package index contains a package."""

    def is_key(self, name: str) -> bool:
        """Return whether a name is a rosdep key."""

    def packages_with_module(self, module: str) -> tuple[str, ...]:
        """Return the packages of the workspace that provide a Python module."""

    def python_modules(self, name: str) -> Known:
        """Return the top-level Python modules of a package."""

    def by_cmake(self, name: str) -> Providers:
        """Return the packages and keys that provide ``name``, the argument of find_package()."""

    def by_include_folder(self, folder: str) -> Providers:
        """Return the packages and keys that provide headers below an include folder such as ``rclcpp``."""

    def meant(self, name: str, *, python: bool) -> Suggestion | None:
        """Return the existing name that an unknown name certainly means, None if there is any doubt."""


_NONE_NEEDED = Providers(none_needed=True)

_APT_PREFIX = re.compile(r"ros-[a-z]+-(?=[a-z])")
"""Prefix of the apt packages of a distribution: "ros-humble-"."""


def by_cmake(world: Layers, name: str) -> Providers:
    """Return the packages and keys that provide ``name``, the argument of find_package()."""
    owners = _in_underlay(world, [underlay.cmake(name) for underlay in world.underlays])
    if world.layer(name) == "workspace":
        return _existing(world, (name,))
    mapped = world.knowledge.names.cmake(name)
    if mapped == (NOTHING_NEEDED,) and not owners:
        return _NONE_NEEDED
    result = _existing(world, (*owners, name, *mapped), keys=mapped)
    if not result.known or owners or result.names[0] == name:
        return result
    return result._replace(sure=world.knowledge.names.is_cmake_usually_declared(name))


def by_macro(world: Layers, package: str) -> Providers:
    """Return the packages and rosdep keys that provide the CMake macros of ``package``.

    Besides ``package``, these are its alternatives: a vendor package, for example, and the rosdep key of the library.
    """
    names = world.knowledge.names.alternatives(package)
    return world.by_cmake(package) if len(names) == 1 else _existing(world, names, keys=names)


def by_include(world: Layers, header: str) -> Providers:
    """Return the packages and keys that provide a header. ``header`` is the path in ``#include <header>``."""
    names = world.knowledge.names
    first, slash, rest = header.partition("/")
    if slash and not world.underlays and not names.maps(first):
        return world.by_include_folder(first)
    shared = names.shares(first)
    second = f"{first}_{rest.partition('/')[0]}" if shared and "/" in rest else ""
    mapped = names.header(header)
    if slash and not shared and world.layer(first) == "workspace":
        return _existing(world, (first,))
    if second and world.layer(second) == "workspace":
        return _existing(world, (second,))
    owners = _in_underlay(world, [underlay.headers(header) for underlay in world.underlays])
    if mapped == (NOTHING_NEEDED,):
        return _NONE_NEEDED
    folder_name = second if shared else first if slash else ""
    result = _existing(world, (*owners, *((folder_name,) if world.is_package(folder_name) else ()), *mapped), keys=mapped)
    if not result.known:
        return result
    by_map = result.names[0] in result.keys or (result.names[0] != folder_name and not owners)
    return result._replace(sure=names.is_header_usually_declared(header)) if by_map else result


def by_include_folder(world: Layers, folder: str) -> Providers:
    """Return the package named like an include folder. By convention, it provides the headers below this folder."""
    return _existing(world, (folder,))


def by_import(world: Layers, module: str) -> Providers:
    """Return the packages and keys that provide a Python module. ``module`` may be dotted."""
    names = world.knowledge.names
    top = module.partition(".")[0]
    if replacement := replacement_key(top, world.knowledge.distro):
        return _existing(world, (replacement,), keys=(replacement,))
    keys = names.module(module)
    if keys == (NOTHING_NEEDED,):
        return _NONE_NEEDED
    packages = world.packages_with_module(top)
    if packages:
        return _existing(world, _with_released(world, top, packages))
    owners = _in_underlay(world, [underlay.modules(top) for underlay in world.underlays])
    differing = names.module_packages(module, world.knowledge.distro)
    module_package = () if any(world.is_package(name) for name in differing) or not _has_module(world, top) else (top,)
    return _existing(world, (*owners, *differing, *module_package, *keys), keys=keys)


def _with_released(world: Layers, module: str, packages: tuple[str, ...]) -> tuple[str, ...]:
    """Return the packages that provide a Python module, best first, given those of the workspace (``packages``).

    The released package with the name of the module comes first if it certainly has the module, last if it may have it, and
    is left out if it lacks it.
    """
    if module in packages or world.layer(module) == "workspace":
        return packages
    answer = world.python_modules(module).ask(module) if world.is_package(module) else "missing"
    if answer == "missing":
        return packages
    return (module, *packages) if answer == "exists" else (*packages, module)


def importable_modules(script: BuildScript, files: Sequence[str]) -> tuple[str, ...] | None:
    """Return the names of the top-level Python modules that a package installs, None if unknown.

    ``files`` are the files of the package. Folders without Python files and folders with usual names for data, such as
    ``config``, are left out, because ``find_namespace_packages()`` counts every folder as a package.
    """
    tops = dict.fromkeys(name.partition(".")[0] for name in script.products.python_packages)
    modules: dict[str, bool] = {}
    for file in files if tops else ():
        top, slash, rest = file.removeprefix("src/").partition("/")
        if slash and top in tops:
            is_module = rest == "__init__.py" or (rest.endswith(".py") and top not in _DATA_FOLDERS)
            modules[top] = modules.get(top, False) or is_module
    result = tuple(dict.fromkeys([*(top for top in tops if modules.get(top, True)), *_installed_modules(script)]))
    return result if result or _has_no_module(script, files) else None


def _installed_modules(script: BuildScript) -> Iterator[str]:
    """Yield the names of the modules whose files CMake installs into a folder of ``sys.path``."""
    for provided in script.products.installs:
        if provided.path.endswith(".py") and provided.importable:
            top = provided.path.partition("-packages/")[2].partition("/")[0].removesuffix(".py")
            if top != "__init__":
                yield top


def _has_no_module(script: BuildScript, files: Iterable[str]) -> bool:
    """Return whether a package certainly provides no Python module.

    This holds if none of its files can become a module and CMake finds no tool that generates Python bindings.
    """
    if any(mention.name.lower().startswith(_BINDING_TOOLS) for mention in script.mentions if mention.via == "cmake"):
        return False
    return not any(file.endswith(_MODULE_SUFFIXES) and not (is_auxiliary(file) or ".launch." in file) for file in files)


_BINDING_TOOLS = ("python", "pybind11", "nanobind", "swig")
_MODULE_SUFFIXES = (".py", ".pyx", ".i", ".idl", ".msg", ".srv", ".action")


_DATA_FOLDERS = frozenset(
    {
        "launch", "config", "configs", "cfg", "params", "param", "resource", "resources", "urdf", "meshes", "models", "worlds",
        "world", "maps", "map", "rviz", "scenarios", "test", "tests", "doc", "docs", "examples", "images", "scripts", "include",
        "msg", "srv", "action", "build", "install", "log",
    }
)  # fmt: skip
"""Names of folders that usually contain no Python modules."""


def meant(world: Layers, name: str, *, python: bool) -> Suggestion | None:
    """Return the existing name that an unknown name certainly means, None if there is any doubt.

    If ``python`` is True, the name is needed to run Python code, so names for find_package() are not considered.
    """
    names = world.knowledge.names
    package = name.replace(".", "/").partition("/")[0]
    if package != name and world.is_package(package):  # an interface or a module: std_msgs/msg/String, rclpy.qos
        return Suggestion(package, "spelling")
    released = _APT_PREFIX.match(name)
    package = name[released.end() :].replace("-", "_") if released else ""
    if package and world.is_package(package):  # ros-humble-tf2-ros
        return Suggestion(package, "system")
    libraries = () if python else tuple(_libraries(names.cmake(name)))
    if libraries:
        return _first_candidate(world, libraries, "cmake")  # a build uses no pip packages
    same_spelling = _declarable(world, world.spelling.same(name))
    if same_spelling:
        return Suggestion(same_spelling[0], "spelling") if len(same_spelling) == 1 else None
    for suggestion in _other_names(world, name, python=python):
        if suggestion is not None:
            return suggestion
    slips = _declarable(world, world.spelling.one_slip(name))
    if python:  # Python does not use C libraries directly: the key for pyaml is that of the module, not of libyaml
        slips = _declarable(world, (slip if world.is_package(slip) else f"python3-{slip}" for slip in _bare(slips)))
    return Suggestion(slips[0], "slip") if len(slips) == 1 else None


def _bare(names: Iterable[str]) -> Iterator[str]:
    return (name.removeprefix("python3-") for name in names)


def near(world: Layers, name: str, *, python: bool) -> tuple[str, ...]:
    """Return at most three packages and rosdep keys that resemble an unknown name, the most similar first."""
    intended = world.meant(name, python=python)
    candidates = _declarable(world, world.spelling.near(name))
    return tuple(dict.fromkeys([intended.name, *candidates] if intended else candidates))[:3]


def _other_names(world: Layers, name: str, *, python: bool) -> Iterator[Suggestion | None]:
    """Yield the names that may be meant by an unknown name, None for each kind of name in which none fits.

    The kinds are, for example, a CMake package, a header folder, a Python module, an apt package and a pip package.
    """
    names, rosdep = world.knowledge.names, world.knowledge.rosdep
    bare = name.removeprefix("python3-").removeprefix("python-").removesuffix("-pip").removesuffix("-python")
    if python or bare != name:
        yield _first_candidate(world, [f"python3-{bare}", f"python3-{bare}-pip"], "spelling")
        yield _first_candidate(world, (*names.module_packages(bare, world.knowledge.distro), *names.module(bare)), "python")
        yield _only_candidate(world, rosdep.installing(bare))
        yield _first_candidate(world, [f"python3-{bare.removeprefix('py')}"], "spelling")  # pyserial
    else:
        yield _first_candidate(world, _libraries(names.cmake_any_case(name)), "cmake")
        yield _first_candidate(world, names.folder(name), "header")
    yield _only_candidate(world, rosdep.installing(name))


def _libraries(names: Iterable[str]) -> Iterator[str]:
    """Yield the names of libraries, without packages that only contain a find module for CMake."""
    return (name for name in names if name != NOTHING_NEEDED and not name.endswith("_cmake_module"))


def _first_candidate(
    world: Layers, names: Iterable[str], by: Literal["spelling", "cmake", "header", "python"]
) -> Suggestion | None:
    declarable = _declarable(world, names)
    return Suggestion(declarable[0], by) if declarable else None


def _only_candidate(world: Layers, keys: Iterable[str]) -> Suggestion | None:
    declarable = _declarable(world, keys)
    return Suggestion(declarable[0], "system") if len(declarable) == 1 else None


def _declarable(world: Layers, names: Iterable[str]) -> tuple[str, ...]:
    """Return the names that a manifest may declare: packages, and rosdep keys with a rule for the distribution."""
    resolves = world.knowledge.resolves
    return tuple(name for name in names if world.is_package(name) or (world.is_key(name) and resolves(name) is not False))


def _has_module(world: Layers, package: str) -> bool:
    """Return whether a package may have a Python module named like the package; False for a package of the workspace."""
    if world.layer(package) == "workspace":
        return False  # the build script has been consulted already
    return world.is_package(package) and world.python_modules(package).ask(package) != "missing"


def _in_underlay(world: Layers, owners: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    """Return the packages of the topmost underlay in ``owners`` that has packages which the workspace does not override.

    ``owners`` has a tuple of packages for each underlay, the topmost first. Overridden packages are left out.
    """
    for names in owners:
        visible = tuple(name for name in names if world.layer(name) == "underlay")
        if visible:
            return visible
    return ()


def _existing(world: Layers, names: Iterable[str], keys: Iterable[str] = ()) -> Providers:
    """Return the packages and keys among ``names``: existing packages, and existing rosdep keys that are also in ``keys``.

    The order is: packages and keys that resolve, then keys without a rule for the distribution, then packages that only other
    distributions have, such as ``fastrtps``, the former name of ``fastdds``.
    """
    ordered = dict.fromkeys(name for name in names if name != NOTHING_NEEDED)
    allowed = set(keys)
    packages = tuple(name for name in ordered if world.is_package(name))
    as_keys = tuple(name for name in ordered if name in allowed and name not in packages and world.is_key(name))
    existing = [name for name in ordered if name in packages or name in as_keys]
    if as_keys and len(existing) > 1:
        existing.sort(key=lambda name: name in as_keys and world.knowledge.resolves(name) is False)
    if existing:  # declaring the name of the same package in another distribution counts, too
        existing += [name for name in ordered if name not in existing and world.knowledge.elsewhere(name)]
    return Providers(tuple(existing), packages, as_keys)
