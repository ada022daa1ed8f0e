"""The packages to which a name in a source may belong, by the kind of the name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import pytest

from ros_lint.facts.repositories import ExpectedRepositories
from ros_lint.facts.sources import Via
from ros_lint.knowledge.providers import Providers
from ros_lint.knowledge.world import Resolution
from ros_lint.workspace.usage.package_files import PackageSource
from ros_lint.workspace.usage.resolve import ProviderMatch, Resolver

NOTHING = ProviderMatch(())


class Names(NamedTuple):
    """Names that exist, and what is known of the others."""

    packages: tuple[str, ...] = ()
    declared: tuple[str, ...] = ()
    resolutions: Mapping[str, Resolution] = {}
    providers: Mapping[str, Providers] = {}
    """By name, with the kind of the name before a colon."""
    awaited: ExpectedRepositories = ExpectedRepositories()

    def is_package(self, name: str) -> bool:
        return name in self.packages

    def is_declared(self, name: str) -> bool:
        return name in self.declared

    def resolution(self, name: str) -> Resolution:
        return self.resolutions.get(name, "unknown")

    def by_cmake(self, name: str) -> Providers:
        return self.providers.get(f"cmake:{name}", Providers())

    def by_macro(self, package: str) -> Providers:
        return self.providers.get(f"macro:{package}", Providers())

    def by_include(self, header: str) -> Providers:
        return self.providers.get(f"include:{header}", Providers())

    def by_import(self, module: str) -> Providers:
        return self.providers.get(f"import:{module}", Providers())


def source(name: str, *files: str) -> PackageSource:
    return PackageSource(name, name, files, None, {}, (), "ament_cmake")


def resolver_of(names: Names, *sources: PackageSource) -> Resolver:
    resolver = Resolver(names)
    resolver.renew(sources)
    return resolver


def match(via: Via, name: str, names: Names, *sources: PackageSource) -> ProviderMatch:
    return resolver_of(names, *sources).match(via, name)._replace(what="")


# --- names that exist ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("via", "name", "provided", "quotation"),
    [
        ("cmake", "Eigen3", "cmake:Eigen3", "find_package(Eigen3)"),
        ("target", "Eigen3::Eigen", "cmake:Eigen3", "Eigen3::Eigen"),
        ("target", "eigen", "cmake:eigen", "eigen"),
        ("macro", "rosidl::generate", "macro:rosidl", "rosidl::generate()"),
        ("include", "Eigen/Dense", "include:Eigen/Dense", "#include <Eigen/Dense>"),
        ("import", "cv2.aruco", "import:cv2.aruco", "import cv2.aruco"),
    ],
)
@pytest.mark.parametrize("sure", [True, False])
def test_a_name_belongs_to_its_providers(via: Via, name: str, provided: str, quotation: str, sure: bool) -> None:
    resolver = resolver_of(Names(providers={provided: Providers(("first", "second"), sure=sure)}))
    expected = ProviderMatch(("first", "second"), sure, quotation)
    assert resolver.match(via, name) == resolver.match(via, name) == expected


@pytest.mark.parametrize(
    ("via", "name", "quotation"),
    [
        ("package", "tf2", "tf2"),
        ("interface", "tf2/Transform", "tf2/Transform"),
        ("symbol", "tf2", "tf2"),
        ("launch", "tf2", "tf2"),
        ("key", "tf2", "tf2"),
        ("cmake", "tf2", "find_package(tf2)"),
    ],
)
def test_the_name_of_a_package_belongs_to_the_package(via: Via, name: str, quotation: str) -> None:
    assert resolver_of(Names(packages=("tf2",))).match(via, name) == ProviderMatch(("tf2",), True, quotation)


def test_what_needs_no_package_has_no_provider() -> None:
    names = Names(providers={"include:vector": Providers(none_needed=True), "cmake:Threads": Providers(none_needed=True)})
    assert match("include", "vector", names) == match("cmake", "Threads", names) == NOTHING


# --- names that do not exist ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "via_name", [("include", "arm_msgs/msg/a.hpp"), ("import", "arm_msgs.msg"), ("import", "arm_msgs.srv.A")]
)
@pytest.mark.parametrize(
    ("resolution", "declared", "expected"),
    [
        ("elsewhere", False, ProviderMatch(("arm_msgs",))),
        ("end-of-life", False, ProviderMatch(("arm_msgs",), False)),
        ("unknown", False, ProviderMatch(("arm_msgs",), False)),
        ("unknown", True, ProviderMatch(("arm_msgs",), True)),
        ("unknowable", False, NOTHING),
        ("unknowable", True, ProviderMatch(("arm_msgs",), True)),
    ],
)
def test_an_interface_belongs_to_the_package_of_its_name(
    via_name: tuple[Via, str], resolution: Resolution, declared: bool, expected: ProviderMatch
) -> None:
    names = Names(declared=("arm_msgs",) if declared else (), resolutions={"arm_msgs": resolution})
    assert match(*via_name, names) == expected


@pytest.mark.parametrize(
    ("via", "name"),
    [("include", "arm/a.hpp"), ("import", "arm.a"), ("target", "arm::a"), ("macro", "arm::a"), ("launch", "arm")],
)
@pytest.mark.parametrize(
    ("resolution", "expected"),
    [
        ("elsewhere", ProviderMatch(("arm",))),
        ("end-of-life", ProviderMatch(("arm",), False)),
        ("unknown", NOTHING),
        ("unknowable", NOTHING),
    ],
)
def test_another_unknown_name_belongs_to_a_package_of_another_distribution(
    via: Via, name: str, resolution: Resolution, expected: ProviderMatch
) -> None:
    assert match(via, name, Names(declared=("arm",), resolutions={"arm": resolution})) == expected


@pytest.mark.parametrize(("via", "name"), [("package", "arm"), ("interface", "arm/A"), ("cmake", "arm")])
def test_an_unknown_package_is_a_provider_if_a_manifest_declares_it(via: Via, name: str) -> None:
    assert match(via, name, Names()) == NOTHING
    assert match(via, name, Names(declared=("arm",))) == ProviderMatch(("arm",), True)


def test_a_library_with_a_name_that_no_package_can_have_is_no_package() -> None:
    assert match("cmake", "Arm", Names(packages=("Arm",), declared=("Arm",))) == NOTHING
    assert match("symbol", "arm", Names(declared=("arm",))) == NOTHING
    assert match("include", "arm.hpp", Names(resolutions={"arm.hpp": "elsewhere", "": "elsewhere"})) == NOTHING


@pytest.mark.parametrize("resolution", ["known", "elsewhere", "end-of-life", "unknown", "unknowable"])
def test_only_an_unknown_package_whose_files_are_looked_up_is_an_uncertain_provider(resolution: Resolution) -> None:
    resolver = resolver_of(Names(resolutions={"arm": resolution}))
    assert resolver.looked_up("arm") == (ProviderMatch(("arm",), False, "arm") if resolution == "unknown" else NOTHING)
    assert resolver.looked_up("Arm") == NOTHING


# --- names of the workspace ----------------------------------------------------------------------------------------


def test_a_header_of_several_packages_belongs_first_to_the_package_of_its_folder() -> None:
    sources = [source(name, "include/shapes/line.hpp") for name in ("copies", "shapes", "zoo")]
    expected = ProviderMatch(("shapes", "copies", "zoo"))
    assert match("include", "shapes/line.hpp", Names(), *sources) == expected
    assert match("include", "shapes/circle.hpp", Names(), *sources) == NOTHING


@pytest.mark.parametrize(
    ("provided", "expected"),
    [
        (Providers(("fmt", "libfmt-dev"), sure=False), ProviderMatch(("fmt", "libfmt-dev", "robot"), False)),
        (Providers(("fmt",)), ProviderMatch(("fmt", "robot"))),
        (Providers(("fmt", "robot"), sure=False), ProviderMatch(("robot",))),
        (Providers(), ProviderMatch(("robot",))),
    ],
)
def test_a_copy_of_a_header_belongs_first_to_the_library(provided: Providers, expected: ProviderMatch) -> None:
    names = Names(providers={"include:fmt/core.h": provided, "include:core.h": provided})
    assert match("include", "fmt/core.h", names, source("robot", "include/fmt/core.h")) == expected
    assert match("include", "core.h", names, source("robot", "include/core.h")) == ProviderMatch(("robot",))


@pytest.mark.parametrize(("module", "is_interface"), [("arm.msg", True), ("arm.action.A", True), ("arm.messages", False)])
def test_an_interface_module_of_the_workspace_belongs_to_its_package(module: str, is_interface: bool) -> None:
    names = Names(resolutions={"arm": "known"})
    assert match("import", module, names, source("arm")) == (ProviderMatch(("arm",)) if is_interface else NOTHING)
    assert match("import", module, names, source("leg")) == NOTHING
