"""What is known of the released world: every line shipped, damaged files, upstream's formats."""

from __future__ import annotations

import gzip
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from catkin_pkg.package import parse_package_string

from ros_lint.collectors import manifest as manifests
from ros_lint.commands import index as command
from ros_lint.knowledge import Knowledge, distros, index, newest_lts, provides, rosdep, rosdep_rules, upstream
from ros_lint.knowledge.builtin import PYTHON_MODULES
from ros_lint.knowledge.manifests import context, describe
from ros_lint.knowledge.names import NOTHING_NEEDED, Names
from ros_lint.knowledge.provides import Known
from ros_lint.knowledge.rosdep import PLATFORMS
from ros_lint.knowledge.spelling import Spelling
from ros_lint.knowledge.store import SHIPPED, KnowledgeError, Store, Table, user_directory
from ros_lint.text import Text

DISTROS = [distro.name for distro in distros()]


# --- the data shipped ----------------------------------------------------------------------------------------------


def test_distributions_are_told_by_what_there_is() -> None:
    assert DISTROS == ["humble", "jazzy", "kilted", "lyrical", "rolling"]
    assert [distro.name for distro in distros() if distro.long_term] == ["humble", "jazzy", "lyrical"]
    assert newest_lts() == "lyrical"
    assert {*DISTROS} <= PLATFORMS.keys()
    assert {platform for name in DISTROS for platform in PLATFORMS[name]} <= {*rosdep.LETTERS.values()}


def test_a_distribution_that_comes_later_is_known_by_its_letter(tmp_path: Path) -> None:
    for name in ("marvin", "nimbus", "local"):
        (tmp_path / f"{name}.idx").write_text(index.render_file(name, "", "2028-06-01", []))
    known = {distro.name: distro.long_term for distro in distros([str(tmp_path)])}
    assert (known["marvin"], known["nimbus"], known["local"]) == (False, True, False)
    assert newest_lts([str(tmp_path)]) == "nimbus"


@pytest.mark.parametrize("distro", DISTROS)
def test_every_line_of_an_index_is_read_and_written_alike(distro: str) -> None:
    head, lines = Store().lines(f"{distro}.idx")
    packages = [index.parse(line.split("\t")) for line in lines]
    assert [index.render(package) for package in packages] == lines
    date, commit = Knowledge(distro).index.date, Knowledge(distro).index.commit
    assert index.render_file(distro, commit, date, packages) == "\n".join([head, *lines, ""])


@pytest.mark.parametrize("distro", DISTROS)
def test_every_package_is_found_and_nothing_else(distro: str) -> None:
    known = Knowledge(distro).index
    names = list(known.names())
    assert len(names) == len(known) == len({*names})
    for name in names:
        package = known.get(name)
        assert package is not None
        assert package.name == name
        assert name in known
        runtime = known.runtime(name)
        if package.described:
            assert runtime is not None
            assert {*runtime} == {*package.on("eux")}
        else:
            assert runtime is None
    for name in names[::7]:
        for wrong in (name[:-1], f"{name}x", name.upper(), ""):
            assert (wrong in known) == (wrong in names)
            assert (known.get(wrong) is not None) == (wrong in names)


@pytest.mark.parametrize("distro", DISTROS)
def test_every_line_of_what_packages_install_is_read_and_written_alike(distro: str) -> None:
    head, lines = Store().lines(f"{distro}.prov")
    found = [provides.parse(line.split("\t")) for line in lines]
    assert [provides.render(each) for each in found] == lines
    assert provides.render_file(distro, found) == "\n".join([head, *lines, ""])
    assert {each.name for each in found} <= {*Knowledge(distro).index.names()}


def test_every_rosdep_key_is_read_and_written_alike() -> None:
    head, lines = Store().lines("rosdep.tsv")
    keys = {line.split("\t")[0]: rosdep.parse(line.split("\t")) for line in lines}
    assert rosdep.render_file(keys) == "\n".join([head, *lines, ""])


def test_the_maps_name_only_what_there_is() -> None:
    """A map may serve one distribution only, but a name that no distribution and no rosdep file has is a misprint."""
    known = {name for distro in DISTROS for name in Knowledge(distro).index.names()}
    known.update(Knowledge("jazzy").rosdep.names())
    store = Store()
    for file in ("cmake_ros.tsv", "cmake_system.tsv", "include_ros.tsv", "include_system.tsv", "ros1_successors.tsv"):
        for line in store.lines(file)[1]:
            names = {*(line + "\t").split("\t")[1].split()} - {NOTHING_NEEDED}
            assert names <= known, f"{file}: {line}"


def test_end_of_life_names_are_in_no_active_distribution() -> None:
    active = {name for distro in DISTROS for name in Knowledge(distro).index.names()}
    names = Names(Store())
    retired = [line.split("\t")[0] for line in Store().lines("eol_names.tsv")[1]]
    assert not active & {*retired}
    assert all(names.end_of_life(name) for name in retired)
    assert names.end_of_life("roscpp") == ("ROS 1 Noetic", "ROS 1 Melodic", "ROS 1 Kinetic")
    assert names.end_of_life("rclcpp") == ()


def test_a_package_as_the_index_has_it() -> None:
    known = Knowledge("jazzy")
    package = known.index.get("std_msgs")
    assert package is not None
    assert (package.build_type, package.interfaces, package.repository) == ("ament_cmake", True, "common_interfaces")
    assert package.on("x") == ("builtin_interfaces", "rosidl_default_runtime")
    assert package.groups == ("rosidl_interface_packages",)
    assert "std_msgs" in set(known.index.members("rosidl_interface_packages"))
    assert "rmw_fastrtps_cpp" in set(known.index.members("rmw_implementation_packages"))
    assert known.date == "2026-08-22"
    assert known.elsewhere("gazebo_ros") == ("humble",)


def test_three_answers() -> None:
    known = Known(("talker",), ("listener",), complete=True)
    assert [known.ask(name) for name in ("talker", "listener", "speaker")] == ["exists", "unknowable", "missing"]
    assert Known(("talker",)).ask("speaker") == "unknowable"
    endings = Known(("a.launch.py",), complete=True, endings=("launch.py",))
    assert [endings.ask(name) for name in ("a.launch.py", "b.launch.py", "b.py")] == ["exists", "missing", "unknowable"]


@pytest.mark.parametrize(("origin", "answer"), [("=", "missing"), ("b", "missing"), ("~", "unknowable")])
def test_absence_is_claimed_from_solid_lines_only(origin: str, answer: str) -> None:
    found = provides.parse(["demo", origin, "X:talker listener?", "Y"])
    assert found.known("executables").ask("speaker") == answer
    assert found.known("executables").ask("listener") == "unknowable"
    assert found.known("modules").ask("demo") == "exists"
    assert Knowledge("jazzy").provides.known("no_such_package", "executables").ask("x") == "unknowable"


def test_a_distribution_without_an_index_is_not_covered() -> None:
    for name in ("iron", "../data/jazzy", ""):
        known = Knowledge(name)
        assert (known.covered, known.date, list(known.index.names())) == (False, "", [])
        assert known.resolves("eigen") is (True if name == "iron" else None)


def test_rosdep_keys_are_asked_for_the_platform_of_the_distribution() -> None:
    humble, jazzy = Knowledge("humble"), Knowledge("jazzy")
    assert (humble.resolves("eigen"), jazzy.resolves("eigen")) == (True, True)
    assert (humble.resolves("gazebo"), jazzy.resolves("gazebo")) == (True, False)
    assert jazzy.resolves("ament_python") is None
    assert jazzy.resolving("gazebo") == ("humble",)
    assert jazzy.rosdep.installing("uuid-dev") == ("uuid",)
    assert "python3-numpy" in jazzy.rosdep
    assert jazzy.platform == "ubuntu:noble"


@pytest.mark.parametrize(
    ("header", "first"),
    [
        ("Eigen/Dense", "eigen"),
        ("yaml-cpp/yaml.h", "yaml-cpp"),
        ("boost/filesystem/path.hpp", "libboost-filesystem-dev"),
        ("boost/optional.hpp", "boost"),
        ("OgreVector3.h", "rviz_ogre_vendor"),
        ("moveit/benchmarks/server.h", "moveit_ros_benchmarks"),
        ("autoware/adapi_specs/routing.hpp", "autoware_adapi_specs"),
        ("vector", "-"),
        ("sys/types.h", "-"),
        ("unistd.h", "-"),
    ],
)
def test_headers_by_the_longest_prefix(header: str, first: str) -> None:
    assert Names(Store()).header(header)[0] == first


def test_headers_that_say_nothing() -> None:
    names = Names(Store())
    assert names.header("my_node.hpp") == names.header("ros_utils.h") == names.header("rclcpp/rclcpp.hpp") == ()
    assert names.shares("moveit")
    assert not names.shares("rclcpp")


def test_python_modules() -> None:
    names = Names(Store())
    assert names.module("cv2")[0] == "python3-opencv"
    assert names.module("google.protobuf.message") == ("python3-protobuf",)
    assert names.module("google") == ()  # the files of another distribution alone say so
    assert names.module("os.path") == names.module("tomllib") == names.module("distutils") == (NOTHING_NEEDED,)
    assert names.module_packages("tf2_ros", "humble") == ("tf2_ros_py",)
    assert names.module_packages("moveit", "humble") == ("moveit_task_constructor_core",)
    assert names.module_packages("scripts", "humble") == ()
    assert {*sys.stdlib_module_names} - {name for name in sys.stdlib_module_names if name[0] == "_"} <= PYTHON_MODULES


def test_cmake_names() -> None:
    names = Names(Store())
    assert names.cmake("Eigen3")[0] == "eigen"
    assert names.cmake("Threads") == names.cmake("UnixCommands") == (NOTHING_NEEDED,)
    assert names.cmake("ament_cmake_internal") == ("ament_cmake_core",)
    assert names.cmake("nothing_of_the_kind") == ()
    assert names.cmake_any_case("opencv") == names.cmake("OpenCV")


# --- where the data are ---------------------------------------------------------------------------------------------


def test_what_the_user_refreshed_goes_before_what_ships(tmp_path: Path) -> None:
    package = index.Released("only_here", "1.0.0", "c", "only_here", {"x": ("rclcpp",)})
    (tmp_path / "jazzy.idx").write_text(index.render_file("jazzy", "", "2030-01-01", [package]))
    known = Knowledge("jazzy", [str(tmp_path)])
    assert list(known.index.names()) == ["only_here"]
    assert known.date == "2030-01-01"
    assert "eigen" in known.rosdep
    assert known.elsewhere("rclcpp") == ("humble", "kilted", "lyrical", "rolling")


def test_the_users_data_folder() -> None:
    assert user_directory({"XDG_DATA_HOME": "/data", "HOME": "/home/ada"}) == "/data/ros-lint/index"
    assert user_directory({"XDG_DATA_HOME": "relative", "HOME": "/home/ada"}) == "/home/ada/.local/share/ros-lint/index"


def test_loading_needs_nothing_heavy() -> None:
    code = (
        "import sys; from ros_lint.knowledge import Knowledge; known = Knowledge('jazzy'); known.index.get('rclcpp');"
        "known.rosdep.get('eigen'); known.names.header('Eigen/Dense'); known.provides.get('rclcpp');"
        "print(sorted({'yaml', 'json', 'lxml', 'networkx', 'libcst', 'importlib.metadata', 'dataclasses', 'urllib.request',"
        " 'importlib.resources', 'difflib'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# --- damaged files --------------------------------------------------------------------------------------------------


def _damages() -> list[tuple[str, bytes]]:
    whole = Path(SHIPPED, "kilted.idx").read_bytes()
    lines = whole.split(b"\n")
    cuts = random.Random(1).sample(range(1, len(whole) - 1), 20)
    return [
        *((f"cut at {cut}", whole[:cut]) for cut in cuts),
        ("empty", b""),
        ("no head", b"\n".join(lines[1:])),
        ("another head", b"#ros-index 2 distro=kilted packages=1\na\t\tc\n"),
        ("a line missing", b"\n".join(lines[:50] + lines[51:])),
        ("two lines swapped", b"\n".join([*lines[:50], lines[51], lines[50], *lines[52:]])),
        ("binary", bytes(range(256)) * 40),
        ("no UTF-8", whole[:5000] + b"\xff\xfe" + whole[5000:]),
        ("a web page", b"<!DOCTYPE html>\n<html></html>\n"),
    ]


@pytest.mark.parametrize("damage", [data for _, data in _damages()], ids=[name for name, _ in _damages()])
def test_a_damaged_index_is_named(damage: bytes, tmp_path: Path) -> None:
    path = tmp_path / "kilted.idx"
    path.write_bytes(damage)
    with pytest.raises(KnowledgeError) as raised:
        _ = Knowledge("kilted", [str(tmp_path)]).index
    assert str(path) in str(raised.value)
    assert "index refresh" in str(raised.value) or "format" in str(raised.value)


def test_a_line_that_makes_no_sense_is_named(tmp_path: Path) -> None:
    (tmp_path / "jazzy.idx").write_text("#ros-index 1 distro=jazzy date=2026-01-01 packages=1\na\t1.0.0\tc\t\tb rclcpp\n")
    (tmp_path / "jazzy.prov").write_text("#ros-provides 1 distro=jazzy packages=1\na\t=\tXY:z\n")
    (tmp_path / "rosdep.tsv").write_text("# key\ta\na\tQ\n")
    known = Knowledge("jazzy", [str(tmp_path)])
    for look_up in (known.index.get, known.provides.get, known.rosdep.get):
        with pytest.raises(KnowledgeError, match="line of a makes no sense"):
            look_up("a")


def test_an_unreadable_index_is_named(tmp_path: Path) -> None:
    (tmp_path / "jazzy.idx").mkdir()  # no file: what ships is used
    assert Knowledge("jazzy", [str(tmp_path)]).covered
    (tmp_path / "rosdep.tsv").write_text("not a table\n")
    with pytest.raises(KnowledgeError, match="no head line"):
        _ = Knowledge("jazzy", [str(tmp_path)]).rosdep


def test_one_line_has_one_field() -> None:
    table = Table(["a", "a-b\t1", "ab\t2"])
    assert table.row("a") == ["a"]
    assert table.row("a-b") == ["a-b", "1"]
    assert "ab" in table
    assert "b" not in table


# --- manifests to lines ---------------------------------------------------------------------------------------------

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>1.2.3</version><description>d</description>
  <maintainer email="ada@robots.example">Ada</maintainer><license>Apache-2.0</license>
  {body}
</package>
"""
BODIES = [
    "<depend>rclcpp</depend><exec_depend>rclcpp</exec_depend>".replace("exec_depend>rclcpp", "exec_depend>rclpy"),
    "<buildtool_depend>ament_cmake</buildtool_depend><export><build_type>ament_cmake</build_type></export>",
    '<build_depend condition="$ROS_VERSION == 1">roscpp</build_depend><depend condition="$ROS_VERSION == 2">rclcpp</depend>',
    '<depend condition="$ROS_DISTRO == humble">a</depend><depend condition="$ROS_DISTRO != humble">b</depend>',
    '<exec_depend condition="$UNSET != 1">a</exec_depend><exec_depend condition="$UNSET == 1">b</exec_depend>',
    "<buildtool_export_depend>a</buildtool_export_depend><build_export_depend>a</build_export_depend><test_depend>a</test_depend>"
    "<doc_depend>sphinx</doc_depend>",
    "<group_depend>rmw_implementation_packages</group_depend><member_of_group>rosidl_interface_packages</member_of_group>"
    "<member_of_group>other</member_of_group>",
    '<export><build_type condition="$ROS_VERSION == 1">catkin</build_type>'
    '<build_type condition="$ROS_VERSION == 2">ament_python</build_type></export>',
]


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # catkin_pkg and pyparsing
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("distro", ["humble", "jazzy"])
def test_a_manifest_gives_what_catkin_pkg_reads(body: str, distro: str) -> None:
    text = MANIFEST.format(name="demo", body=body)
    ours = describe(manifests.collect(Text("package.xml", text)), context(distro))
    theirs = parse_package_string(text)
    theirs.evaluate_conditions(dict(context(distro)))
    kinds = {
        "b": theirs.build_depends,
        "t": theirs.buildtool_depends,
        "e": theirs.build_export_depends,
        "u": theirs.buildtool_export_depends,
        "x": theirs.exec_depends,
        "s": theirs.test_depends,
        "d": theirs.doc_depends,
        "G": theirs.group_depends,
        "M": [group for group in theirs.member_of_groups if group.name != "rosidl_interface_packages"],
    }
    expected = {kind: tuple(sorted({dep.name for dep in deps if dep.evaluated_condition})) for kind, deps in kinds.items()}
    assert ours.depends == {kind: names for kind, names in expected.items() if names}
    assert ours.build_type == theirs.get_build_type()
    assert ours.interfaces == ("rosidl_interface_packages" in [group.name for group in theirs.member_of_groups])
    assert index.parse(index.render(ours).split("\t")).on("bteuxsdMG") == ours.on("bteuxsdMG")


# --- upstream's files ------------------------------------------------------------------------------------------------


def _upstream(folder: Path, *, packed: bool = False) -> str:
    def xml(name: str, body: str = "", version: str = "1.2.3") -> str:
        return MANIFEST.format(name=name, body=body).replace("1.2.3", version)

    cache = {
        "type": "cache",
        "version": 2,
        "name": "jazzy",
        "release_package_xmls": {
            "arm": xml("arm", BODIES[1]),
            "arm_msgs": xml("arm_msgs", BODIES[6]),
            "old": xml("old", version="1.0.0"),
            "gone": xml("gone"),
            "liar": xml("somebody_else"),
            "overlaid": xml("overlaid"),
        },
        "source_repo_package_xmls": {"leg": {"_ref": "abc", "leg": ["leg", xml("leg", BODIES[0])]}},
    }
    release = {"tags": {"release": "x"}, "url": "https://example.org/r.git"}
    repositories = {
        "arm": {"release": {**release, "packages": ["arm", "arm_msgs"], "version": "1.2.3-4"}, "status": "maintained"},
        "old": {"release": {**release, "version": "1.2.3-1"}},
        "ended": {"release": {**release, "packages": ["gone"], "version": "1.2.3-1"}, "status": "end-of-life"},
        "leg": {"release": {**release}, "source": {"type": "git"}},
        "never": {"release": {**release}},
        "liar": {"release": {**release, "version": "1.2.3-1"}},
        "lost": {"release": {**release, "version": "2.0.0-1"}},
        "source_only": {"source": {"type": "git"}},
        "overlaid": {"release": {**release, "version": "1.0.0-1"}},
    }
    overlay = {"repositories": {"overlaid": {"release": {**release, "version": "1.2.3-1"}}}}
    entry = {"distribution_cache": "cache.yaml", "distribution_status": "active", "distribution_type": "ros2"}
    files = {
        "index-v4.yaml": {
            "distributions": {
                "jazzy": {**entry, "distribution": ["jazzy/distribution.yaml", "jazzy/overlay.yaml"]},
                "foxy": {**entry, "distribution": ["foxy.yaml"], "distribution_status": "end-of-life"},
                "noetic": {**entry, "distribution": ["noetic.yaml"], "distribution_type": "ros1"},
            },
            "type": "index",
            "version": 4,
        },
        "jazzy/distribution.yaml": {"repositories": repositories, "type": "distribution", "version": 2},
        "jazzy/overlay.yaml": overlay,
        "cache.yaml": cache,
    }
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        data = yaml.safe_dump(content).encode()
        path.write_bytes(gzip.compress(data) if packed and name == "cache.yaml" else data)
    return str(folder / "index-v4.yaml")


EXPECTED = """\
#ros-index 1 distro=jazzy rosdistro=unknown date=2026-09-01 packages=9
arm\t1.2.3\tc\t\tt:ament_cmake
arm_msgs\t1.2.3\tki\tarm\tG:rmw_implementation_packages\tM:other
gone\t1.2.3\tkE\tended
leg\t\tkU\t\tbex:rclcpp\tx:rclpy
liar\t1.2.3\t?-
lost\t2.0.0\t?-
never\t\t?U
old\t1.2.3\tk~
overlaid\t1.2.3\tk
"""


@pytest.mark.parametrize("packed", [False, True])
def test_upstreams_files_become_an_index(packed: bool, tmp_path: Path) -> None:
    to = tmp_path / "data"
    (written,) = command.refresh(_upstream(tmp_path / "up", packed=packed), [], str(to), date="2026-09-01")
    assert (to / "jazzy.idx").read_text() == EXPECTED
    assert (written.path, written.lines, written.added) == (str(to / "jazzy.idx"), 9, 9)
    assert written.removed == len(Knowledge("jazzy").index)
    assert [path.name for path in to.iterdir()] == ["jazzy.idx"]
    known = Knowledge("jazzy", [str(to)])
    assert known.date == "2026-09-01"
    assert known.index.runtime("leg") is None
    assert known.index.runtime("arm") == ()


def test_an_index_by_address(tmp_path: Path) -> None:
    address = Path(_upstream(tmp_path)).as_uri()
    assert {source.cache for source in upstream.sources(address).values()} == {(tmp_path / "cache.yaml").as_uri()}
    assert len(list(upstream.packages(upstream.sources(address)["jazzy"]))) == 9


def test_a_second_refresh_says_what_has_changed(tmp_path: Path) -> None:
    source = _upstream(tmp_path / "up")
    command.refresh(source, ["jazzy"], str(tmp_path), date="2026-09-01")
    file = tmp_path / "up/jazzy/distribution.yaml"
    file.write_text(file.read_text().replace("1.2.3-4", "1.2.4-1").replace("never:", "now:"))
    (written,) = command.refresh(source, ["jazzy"], str(tmp_path), date="2026-09-02")
    assert (written.added, written.removed, written.changed) == (1, 1, 2)
    assert str(written) == f"{tmp_path}/jazzy.idx: 9 lines, 1 added, 1 removed, 2 changed"


def test_the_command_says_what_it_wrote(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = {"action": "refresh", "source": _upstream(tmp_path / "up"), "distro": ["jazzy"], "rosdep": [], "to": ""}
    assert command.run(options) == 0
    assert "ros-lint/index/jazzy.idx: 9 lines" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("file", "content", "says"),
    [
        ("index-v4.yaml", None, "cannot be read"),
        ("index-v4.yaml", "distributions: [", "is no YAML"),
        ("index-v4.yaml", "[]", "has no mapping 'distributions'"),
        ("index-v4.yaml", "distributions: {jazzy: 1}", "distribution jazzy has no list of files"),
        ("index-v4.yaml", "distributions: {jazzy: {distribution: []}}", "names no cache for jazzy"),
        ("cache.yaml", None, "cannot be read"),
        ("cache.yaml", "\x1f\x8b", "cannot be read"),
        ("cache.yaml", "{}", "has no mapping 'release_package_xmls'"),
        ("cache.yaml", "{release_package_xmls: 3}", "has no mapping 'release_package_xmls'"),
        ("jazzy/distribution.yaml", None, "cannot be read"),
        ("jazzy/distribution.yaml", "{repositories: []}", "has no mapping 'repositories'"),
    ],
)
def test_what_cannot_be_refreshed_is_named_and_leaves_the_old(
    file: str, content: str | None, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = _upstream(tmp_path / "up")
    to = tmp_path / "data"
    command.refresh(source, ["jazzy"], str(to), date="2026-09-01")
    path = tmp_path / "up" / file
    path.unlink()
    if content is not None:
        path.write_bytes(content.encode("latin-1"))
    options = {"action": "refresh", "source": source, "distro": ["jazzy"], "rosdep": [], "to": str(to)}
    assert command.run(options) == 2
    said = capsys.readouterr().err
    assert said.startswith("ros-lint: ")
    assert says in said
    assert [path.name for path in to.iterdir()] == ["jazzy.idx"]
    assert (to / "jazzy.idx").read_text() == EXPECTED


def test_an_unknown_distribution_is_answered_with_those_that_there_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = {"action": "refresh", "source": _upstream(tmp_path), "distro": ["jazy"], "rosdep": [], "to": str(tmp_path)}
    assert command.run(options) == 2
    assert "has no distribution jazy, only foxy, jazzy, noetic" in capsys.readouterr().err


def test_only_addresses_of_files_and_the_web_are_followed() -> None:
    with pytest.raises(KnowledgeError, match="only http, https and file"):
        upstream.read("ftp://example.org/index-v4.yaml")


RULES = """
apt_everywhere: {ubuntu: [a], debian: [b, a]}
by_version: {ubuntu: {jammy: [j], noble: null, '*': [rest]}}
by_installer: {ubuntu: {pip: {packages: [Thing]}}, fedora: {'*': {dnf: {packages: [thing]}}}}
mixed: {ubuntu: {noble: {pip: {packages: [x]}}, '*': {apt: {packages: [y]}}}, gentoo: [z]}
anywhere: {'*': {pip: {packages: [w]}}}
nothing_to_install: {ubuntu: []}
gone: {ubuntu: {bionic: [old]}}
one_word: {ubuntu: name}
"""


def test_rosdep_rules_are_read_as_rosdep_reads_them() -> None:
    """What rosdep's own resolver says of these rules (REP 111), written down."""
    found = rosdep_rules.keys([("osx", {"only_osx": {"osx": {}}, "both": {"osx": {"homebrew": {"packages": ["q"]}}}}),
                               ("base", {**yaml.safe_load(RULES), "both": {"ubuntu": ["b"]}}),
                               ("python", {"apt_everywhere": {"fedora": ["late"]}})])  # fmt: skip
    lines = {name: rosdep.render(key).split("\t")[1:] for name, key in found.items()}
    assert lines == {
        "apt_everywhere": ["jnrbt", "a b"],
        "by_version": ["jr", "j rest"],
        "by_installer": ["jnrf", "", "Thing"],
        "mixed": ["jnr", "y", "x"],
        "anywhere": ["jnrbt89XfAo", "", "w"],
        "nothing_to_install": ["jnr"],
        "gone": [],
        "one_word": ["jnr", "name"],
        "both": ["jnro", "b"],
    }
    with pytest.raises(KnowledgeError, match="no file of rosdep rules"):
        rosdep_rules.keys([("x", [])])
    with pytest.raises(KnowledgeError, match="rule of a is no mapping"):
        rosdep_rules.keys([("x", {"a": "b"})])


def test_rosdep_rules_are_refreshed_with_an_index(tmp_path: Path) -> None:
    (tmp_path / "rules.yaml").write_text(RULES)
    written = command.refresh(
        _upstream(tmp_path / "up"), ["jazzy"], str(tmp_path / "to"), [str(tmp_path / "rules.yaml")], "2026-09-01"
    )
    assert [Path(each.path).name for each in written] == ["jazzy.idx", "rosdep.tsv"]
    assert Knowledge("jazzy", [str(tmp_path / "to")]).resolves("by_version") is False


# --- near names ------------------------------------------------------------------------------------------------------


def _edits(name: str) -> set[str]:
    """Return every name one letter away, by brute force."""
    letters = "abcdefghijklmnopqrstuvwxyz_-0123456789"
    splits = [(name[:at], name[at:]) for at in range(len(name) + 1)]
    found = {a + b[1:] for a, b in splits if b}
    found |= {a + b[1] + b[0] + b[2:] for a, b in splits if len(b) > 1}
    found |= {a + c + b[1:] for a, b in splits if b for c in letters}
    found |= {a + c + b for a, b in splits for c in letters}
    return found - {name}


def test_slips_are_those_that_brute_force_finds() -> None:
    names = [name for name in Knowledge("jazzy").index.names() if len(name) > 12][::40]
    spelling = Spelling(names)
    chance = random.Random(7)
    for name in names:
        for wrong in chance.sample(sorted(_edits(name)), 25):
            expected = {other for other in _edits(wrong) if other in names}
            assert {*spelling.one_slip(wrong)} <= expected
            if name not in spelling.one_slip(wrong):
                # Digits, dashes and words of few letters are no matter of a slip.
                at = next(i for i in range(len(name) + 1) if name[: i + 1] != wrong[: i + 1])
                changed = name[at : at + 1] + wrong[at : at + 1]
                words = re.findall("[a-z]+", f"{name} {wrong}")
                assert not changed.isalpha() or any(len(word) < 5 for word in words), (name, wrong)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [("laser_filter", "laser_filters"), ("geometry_msg", "geometry_msgs"), ("buildin_interfaces", "builtin_interfaces")],
)
def test_slips(wrong: str, right: str) -> None:
    assert Spelling(Knowledge("jazzy").index.names()).one_slip(wrong) == (right,)


@pytest.mark.parametrize("name", ["python3-pcl", "lcm", "mrpt2", "camera_2", "rclcpp"])
def test_no_slips(name: str) -> None:
    assert Spelling(["python3-pil", "icm", "mrpt1", "camera_1", "rclcpp"]).one_slip(name) == ()


def test_spelling_by_dashes_and_capitals() -> None:
    assert Spelling(["cv_bridge", "turtlebot3_fake_node"]).same("cv-bridge") == ("cv_bridge",)
    assert Spelling(["cv_bridge", "turtlebot3_fake_node"]).same("turtlebot3_fakenode") == ("turtlebot3_fake_node",)
    assert Spelling(["ament_cmake_copyright", "rclcpp"]).near("ament_cmake_lint_copyright") == ("ament_cmake_copyright",)


def test_the_command_line_leads_to_the_command(tmp_path: Path) -> None:
    to = str(tmp_path)
    words = [sys.executable, "-m", "ros_lint", "index", "refresh", "--from", _upstream(tmp_path), "--distro", "jazzy", "--to", to]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout.startswith(f"{to}/jazzy.idx: 9 lines")
    assert (tmp_path / "jazzy.idx").read_text().splitlines()[1:] == EXPECTED.splitlines()[1:]


def test_what_brings_a_name_is_what_walks_to_it() -> None:
    jazzy = index.load(Store(), "jazzy")
    brought = {name: jazzy.brought((name,)) for name in jazzy.names()}
    for name in ("rviz2", "octomap_server", "python3-yaml", "eigen", "rclcpp"):
        having = sum(name in found for other, found in brought.items() if other != name)
        assert jazzy.bringing(name, len(jazzy)) == having
        assert jazzy.bringing(name, 3) > 3 or having <= 3


def test_plugins_of_one_base_stand_together() -> None:
    line = "demo\t=\tP:nav=demo::A,demo::B rviz=demo/C"
    found = provides.parse(line.split("\t"))
    assert found.known("plugins").names == ("nav=demo::A", "nav=demo::B", "rviz=demo/C")
    assert provides.render(found) == line
