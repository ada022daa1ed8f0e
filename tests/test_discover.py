"""Discovery compared with colcon, and additions to colcon."""

from __future__ import annotations

import os
from pathlib import Path
from random import Random

import pytest

from ros_lint.analysis.graph.dependency_graph import build
from ros_lint.base.tree import DiskTree, Entry, MemoryTree
from ros_lint.workspace.discovery.discover import Discovery, Skipped, discover
from tests.colcon_oracle import colcon_list
from tests.packages import CONTEXT, found_package, manifest_text
from tests.workspaces import write_workspace

pytestmark = pytest.mark.slow

SEEDS = range(int(os.environ.get("ROS_LINT_SEEDS", "60")))


def differences(base: Path) -> list[str]:
    """Return the differences between discovery and colcon, in packages and in the edges between them."""
    discovery = discover(DiskTree(str(base)), [""], CONTEXT)
    theirs = colcon_list(base)
    ours = frozenset((package.colcon_name, package.path, package.type) for package in discovery.packages)
    messages = [f"only here: {line}" for line in sorted(ours - theirs.packages)]
    messages += [f"only colcon: {line}" for line in sorted(theirs.packages - ours)]
    names = {name for name, _, _ in theirs.packages}
    for package in map(found_package, discovery.packages):
        name = package.colcon_name
        graph = build(
            [
                package,
                *[other_folder for other_folder in map(found_package, discovery.packages) if other_folder.colcon_name != name],
            ]
        )
        edges = {
            other_folder: {category for reason in reasons for category in reason.categories}
            for other_folder, reasons in graph.needs[name].items()
        }
        expected = {name: set(kinds) for name, kinds in theirs.needs.get(package.path, {}).items() if name in names}
        if edges != expected:
            messages.append(f"{package.path}: needs {edges}, for colcon {expected}")
    return messages


def test_discovery_equals_colcon(tmp_path: Path) -> None:
    packages = 0
    for seed in SEEDS:
        base = tmp_path / str(seed)
        base.mkdir()
        write_workspace(Random(seed), base)
        assert differences(base) == [], f"seed {seed}: {base}"
        packages += len(colcon_list(base).packages)
    assert packages > len(SEEDS), "the generated workspaces must have packages to tell anything"


SCRIPT = "from setuptools import setup\n"


@pytest.mark.parametrize(
    ("setup_py", "extra_files", "name"),
    [
        ("setup(name='x')", {}, "x"),
        ("NAME = 'x'\nsetup(name=NAME, install_requires=['alpha>=1', 'beta'])", {}, "x"),
        ("base = 'x'\nsetup(name=f'{base}_y' + '_z', install_requires=['alpha'])", {}, "x_y_z"),
        ("if __name__ == '__main__':\n    setup(**dict(name='x'), extras_require={'test': ['alpha']})", {}, "x"),
        (
            "import setuptools\nargs = {'name': 'x', 'install_requires': ['alpha>=1 # why']}\nsetuptools.setup(**args)",
            {},
            "x",
        ),
        ("setup(version='1')", {"setup.cfg": "[metadata]\nname = x\n[options]\ninstall-requires = alpha; beta\n"}, "x"),
        ("setup(name='x')", {"setup.cfg": "[metadata]\nname = y\n"}, "x"),
        ("setup(version='1')", {"pyproject.toml": "[project]\nname = 'x'\nversion = '1'\n"}, "x"),
        (
            "setup()",
            {"setup.cfg": "[metadata]\nname = x\n[options.extras_require]\ntesting =\n    alpha [y] >1 # why\n"},
            "x",
        ),
        ("setup()", {}, None),
        ("print('no setup')", {}, None),
        ("setup(name='x'", {}, None),
    ],
)
def test_plain_python_packages_are_found_as_by_colcon(
    tmp_path: Path, setup_py: str, extra_files: dict[str, str], name: str | None
) -> None:
    for file, text in {"p/setup.py": SCRIPT + setup_py, **{f"p/{file}": text for file, text in extra_files.items()}}.items():
        (tmp_path / file).parent.mkdir(exist_ok=True)
        (tmp_path / file).write_text(text)
    for other_folder in ("alpha", "beta"):
        (tmp_path / other_folder).mkdir()
        (tmp_path / other_folder / "package.xml").write_text(manifest_text(other_folder))
    assert differences(tmp_path) == []
    discovery = {package.path: package.name for package in discover(DiskTree(str(tmp_path)), [""]).packages}
    assert discovery.get("p") == name


@pytest.mark.parametrize(
    "setup_py",
    [
        "setup(name=open('name').read())",
        "for n in 'ab':\n    setup(name=n)",
        "setup(name='a')\nsetup(name='b')",
        "setup(**arguments())",
        "n = 'a'\nn = n + 'b'\nsetup(name=n)",
        "setup(name=" + " + ".join(["'a'"] * 1500) + ")",
    ],
)
def test_a_computed_python_package_name_is_reported_as_unknown(setup_py: str) -> None:
    discovery = discover(MemoryTree({"p/setup.py": SCRIPT + setup_py, "p/q/package.xml": manifest_text("q")}), [""])
    assert [package.name for package in discovery.packages] == ["q"]
    assert [(item.what, "colcon may find a package here" in item.reason) for item in discovery.not_checked] == [
        ("p/setup.py", True)
    ]


def test_files_exclude_nested_packages_and_skipped_folders() -> None:
    tree = MemoryTree(
        {
            "w/p/package.xml": manifest_text("p"),
            "w/p/launch/a.launch.py": "",
            "w/p/.hidden/x.yaml": "",
            "w/p/.git/config": "",
            "w/p/src/__pycache__/a.pyc": "",
            "w/p/web/node_modules/a/package.xml": manifest_text("never"),
            "w/p/test/inner/package.xml": manifest_text("inner"),
            "w/p/test/inner/setup.py": "",
            "w/p/test/inner/b.cpp": "",
            "w/p/data/package.xml": manifest_text("data"),
            "w/p/test/c.cpp": "",
            "w/p/old/COLCON_IGNORE": "",
            "w/p/old/package.xml": manifest_text("old"),
            "w/p/scripts/AMENT_IGNORE": "",
            "w/p/scripts/run.py": "",
            "w/p/scripts/more/package.xml": manifest_text("more"),
            "w/p/scripts/more/setup.py": "",
            "w/p/unused/AMENT_IGNORE": "",
            "w/p/unused/package.xml": manifest_text("unused"),
            "w/p/build/CMakeCache.txt": "",
            "w/p/build/x.h": "",
            "w/p/insource/CMakeCache.txt": "",
            "w/p/insource/CMakeLists.txt": "",
            "w/p/venv/pyvenv.cfg": "",
            "w/p/venv/lib/x.py": "",
        }
    )
    discovery = discover(tree, [""])
    (package,) = discovery.packages
    assert package.files == (
        ".hidden/x.yaml",
        "data/package.xml",
        "insource/CMakeCache.txt",
        "insource/CMakeLists.txt",
        "launch/a.launch.py",
        "package.xml",
        "scripts/AMENT_IGNORE",
        "scripts/run.py",
        "test/c.cpp",
    )
    assert [manifest.name for manifest in package.nested] == ["inner"]
    assert [skipped.path for skipped in package.unvisited] == ["build", "old", "scripts/more", "test/inner", "unused", "venv"]


@pytest.mark.parametrize(
    ("scripts", "part"),
    [
        ({"p/CMakeLists.txt": "add_subdirectory(lib/inner)"}, True),
        ({"p/CMakeLists.txt": "add_rosidl_subdirectory(lib/inner)"}, True),
        ({"p/CMakeLists.txt": 'ADD_SUBDIRECTORY( "${CMAKE_CURRENT_SOURCE_DIR}/./lib/inner/" EXCLUDE_FROM_ALL)'}, True),
        ({"p/CMakeLists.txt": "add_subdirectory(lib)", "p/lib/CMakeLists.txt": "add_subdirectory(inner)"}, True),
        ({"p/CMakeLists.txt": "# add_subdirectory(lib/inner)"}, False),
        ({"p/CMakeLists.txt": "add_subdirectory(lib/inner2)"}, False),
        ({"p/setup.py": ""}, False),
    ],
)
def test_a_package_added_by_the_outer_build_is_a_part_of_it(scripts: dict[str, str], part: bool) -> None:
    inner = {"p/lib/inner/package.xml": manifest_text("inner"), "p/lib/inner/CMakeLists.txt": "", "p/lib/inner/src/x.cpp": ""}
    (discovery,) = discover(MemoryTree({"p/package.xml": manifest_text("p"), **inner, **scripts}), [""]).packages
    assert ("lib/inner/src/x.cpp" in discovery.files) == part
    assert [manifest.name for manifest in discovery.nested] == ([] if part else ["inner"])


@pytest.mark.parametrize(
    "files",
    [
        {"install/.colcon_install_layout": "isolated\n"},
        {"install/setup.bash": "", "install/local_setup.bash": ""},
        {"install/setup.sh": "", "install/local_setup.sh": "", "install/_local_setup_util_sh.py": ""},
        {"install/.built_by": "colcon\n"},
        {"install/CMakeCache.txt": ""},
        {"install/pyvenv.cfg": ""},
    ],
)
def test_build_products_are_recognised_by_their_files(files: dict[str, str]) -> None:
    tree = MemoryTree({"install/p/share/p/package.xml": manifest_text("p"), "src/q/package.xml": manifest_text("q"), **files})
    discovery = discover(tree, [""])
    assert [package.path for package in discovery.packages] == ["src/q"]
    assert [skipped.path for skipped in discovery.skipped] == ["install"]


@pytest.mark.parametrize("hook", ["local_setup.dsv", "package.dsv"])
def test_an_installed_package_outside_an_install_tree_is_skipped(hook: str) -> None:
    files = {
        "install/p/share/p/package.xml": manifest_text("p"),
        f"install/p/share/p/{hook}": "",
        "src/p/package.xml": manifest_text("p"),
    }
    discovery = discover(MemoryTree(files), [""])
    assert [package.path for package in discovery.packages] == ["src/p"]
    assert [skipped.path for skipped in discovery.skipped] == ["install/p/share/p"]


def test_a_source_package_with_an_install_file_is_found() -> None:
    tree = MemoryTree({"p/package.xml": manifest_text("p"), "p/package.dsv": "", "p/setup.py": ""})
    assert [package.name for package in discover(tree, [""]).packages] == ["p"]


def test_setup_scripts_in_a_package_do_not_make_an_install_tree() -> None:
    tree = MemoryTree({"p/package.xml": manifest_text("p"), "p/setup.bash": "", "p/local_setup.bash": "", "local_setup.sh": ""})
    assert [package.name for package in discover(tree, [""]).packages] == ["p"]


def test_links_are_followed_without_cycles(tmp_path: Path) -> None:
    package = tmp_path / "ws" / "p"
    (package / "config").mkdir(parents=True)
    (package / "package.xml").write_text(manifest_text("p"))
    (package / "config" / "a.yaml").write_text("")
    (package / "alias").symlink_to("config")
    (package / "config" / "up").symlink_to("../..")
    (package / "itself").symlink_to("itself")
    (package / "outside").symlink_to(tmp_path / "other")
    (package / "root").symlink_to("/")
    (tmp_path / "other").mkdir()
    (tmp_path / "ws" / "shared" / "deep").mkdir(parents=True)
    (tmp_path / "ws" / "shared" / "deep" / "b.yaml").write_text("")
    (tmp_path / "ws" / "shared" / "back").symlink_to("../p/shared")
    (package / "shared").symlink_to("../shared")
    discovery = discover(DiskTree(str(tmp_path / "ws")), [""])
    assert discovery.packages[0].files == ("alias/a.yaml", "config/a.yaml", "package.xml", "shared/deep/b.yaml")
    assert discovery.packages[0].unvisited == (
        Skipped("alias/up", "a link to a folder that contains it", link=True),
        Skipped("config/up", "a link to a folder that contains it", link=True),
        Skipped("outside", "a link that leads out of the workspace", link=True),
        Skipped("root", "a link to a folder that contains it", link=True),
        Skipped("shared/back", "a link to a folder that contains it", link=True),
    )


def test_a_link_to_a_folder_around_the_workspace_is_not_followed(tmp_path: Path) -> None:
    for name in ("ws/p", "elsewhere", "around"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "package.xml").write_text(manifest_text(name.replace("/", "_")))
    (tmp_path / "ws" / "up").symlink_to("..")
    (tmp_path / "ws" / "root").symlink_to("/")
    (tmp_path / "ws" / "beside").symlink_to("../elsewhere")
    (tmp_path / "ws" / "again").symlink_to(".")
    discovery = discover(DiskTree(str(tmp_path / "ws")), [""])
    assert [(package.path, package.name) for package in discovery.packages] == [("beside", "elsewhere"), ("p", "ws_p")]
    assert [skipped.path for skipped in discovery.skipped] == ["root", "up"]


def test_mutual_links_do_not_multiply_files(tmp_path: Path) -> None:
    folders = [tmp_path / "p" / name for name in "abcdefghij"]
    for folder in folders:
        folder.mkdir(parents=True)
        (folder / "x").write_text("")
    for folder in folders:
        for other_folder in folders:
            if other_folder != folder:
                (folder / f"to_{other_folder.name}").symlink_to(other_folder)
    (tmp_path / "p" / "package.xml").write_text(manifest_text("p"))
    files = discover(DiskTree(str(tmp_path)), [""]).packages[0].files
    assert {"a/x", "a/to_b/x", "j/to_i/x"} <= set(files)
    assert len(files) < 10 * 10 * 10


class _Closed(DiskTree):
    """A disk on which some places cannot be read, also by root."""

    def list(self, path: str) -> list[Entry]:
        if path.endswith("closed"):
            raise PermissionError(13, "Permission denied", path)
        return super().list(path)

    def read(self, path: str) -> bytes:
        if "secret" in path:
            raise PermissionError(13, "Permission denied", path)
        return super().read(path)


def test_unreadable_places_are_reported_and_others_are_found(tmp_path: Path) -> None:
    for folder in ("closed", "p/closed", "p/secret", "secret", "z"):
        (tmp_path / folder).mkdir(parents=True)
    for folder in ("p", "p/secret", "secret", "z"):
        (tmp_path / folder / "package.xml").write_text(manifest_text(folder.replace("/", "_")))
    (tmp_path / "p/secret/setup.py").write_text("")
    discovery = discover(_Closed(str(tmp_path)), ["", "missing"])
    assert [package.name for package in discovery.packages] == ["p", "z"]
    assert [(item.what, item.reason) for item in discovery.not_checked] == [
        ("closed", "Permission denied"),
        ("missing", "No such file or directory"),
        ("p/closed", "Permission denied"),
        ("p/secret/package.xml", "Permission denied"),
        ("secret/package.xml", "Permission denied"),
    ]


def test_unusual_names_and_a_folder_named_package_xml_are_handled(tmp_path: Path) -> None:
    for folder in ("my ws/größe", "my ws/package.xml/q", "\udcff"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "package.xml").write_text(manifest_text("p"))
    assert differences(tmp_path) == []
    discovery = discover(DiskTree(str(tmp_path)), [""])
    assert [package.path for package in discovery.packages] == ["my ws/größe", "my ws/package.xml/q", "\udcff"]


def test_the_base_can_be_a_package_and_roots_may_overlap() -> None:
    tree = MemoryTree({"package.xml": manifest_text("p"), "src/q/package.xml": manifest_text("q"), "other/x": ""})
    assert [package.path for package in discover(tree, [""]).packages] == [""]
    assert [package.path for package in discover(tree, ["src", "src/q", "other"]).packages] == ["src/q"]


def test_a_rejected_manifest_without_a_script_is_listed_as_rejected() -> None:
    discovery = discover(MemoryTree({"p/package.xml": "<package/>", "p/q/package.xml": manifest_text("q")}), [""])
    assert [package.name for package in discovery.packages] == ["q"]
    assert [manifest.path for manifest in discovery.rejected] == ["p/package.xml"]


def test_a_rejected_manifest_with_a_script_is_a_plain_package() -> None:
    tree = MemoryTree({"p/package.xml": "<package/>", "p/CMakeLists.txt": "project(other)\nfind_package(q)\n"})
    (package,) = discover(tree, [""]).packages
    assert (package.name, package.type) == ("other", "cmake")
    assert package.manifest is not None
    assert [(depend.name, depend.span.line, depend.span.column) for depend in package.colcon_depends] == [("q", 2, 14)]


@pytest.mark.parametrize("text", ["- a", "a: [", "\udcff", "[" * 3_000, "!x y"])
def test_colcon_files_that_are_not_mappings_are_reported_and_ignored(text: str) -> None:
    data = text.encode("utf-8", "surrogateescape")
    tree = MemoryTree({"colcon.meta": data, "p/package.xml": manifest_text("p"), "p/colcon.pkg": data})
    discovery = discover(tree, [""])
    assert [package.name for package in discovery.packages] == ["p"]
    assert [item.what for item in discovery.not_checked] == ["colcon.meta", "p/colcon.pkg"]


def test_dependencies_in_colcon_files_have_places() -> None:
    tree = MemoryTree(
        {
            "p/package.xml": manifest_text("p"),
            "p/colcon.pkg": "name: p2\ndependencies:\n  - a\n  - 'b'\ntest-dependencies: [c]\n",
            "colcon.meta": "names:\n  p2:\n    run-dependencies: {d: }\npaths:\n  ./p:\n    build-dependencies: [e]\n",
        }
    )
    (package,) = discover(tree, [""]).packages
    assert (package.name, package.colcon_name, package.type) == ("p", "p2", "ros.ament_cmake")
    assert [(depend.name, str(depend.span)) for depend in package.colcon_depends] == [
        ("a", "p/colcon.pkg:3:5"),
        ("b", "p/colcon.pkg:4:5"),
        ("c", "p/colcon.pkg:5:21"),
        ("d", "colcon.meta:3:24"),
        ("e", "colcon.meta:6:26"),
    ]


def test_the_order_of_a_directory_listing_does_not_matter() -> None:
    files = {f"{folder}/package.xml": manifest_text(folder) for folder in ("b", "a", "c")} | {"a/x": "", "a/b/y": ""}

    def discovery(names: list[str]) -> Discovery:
        return discover(MemoryTree({name: files[name] for name in names}), [""])

    assert discovery(list(files)) == discovery(list(reversed(files)))
