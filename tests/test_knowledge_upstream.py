"""Data generated from manifests (compared with catkin_pkg), indexes of rosdistro and rules of rosdep."""

from __future__ import annotations

import gzip
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from catkin_pkg.package import parse_package_string

from ros_lint.base.text import Text
from ros_lint.cli.commands import index as command
from ros_lint.collectors.manifest import collect as manifests
from ros_lint.knowledge import Knowledge, index, rosdep
from ros_lint.knowledge.describe import context, describe
from ros_lint.knowledge.refresh import rosdep_rules
from ros_lint.knowledge.refresh import rosdistro as upstream
from ros_lint.knowledge.store import KnowledgeError

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
def test_the_entry_of_a_manifest_agrees_with_catkin_pkg(body: str, distro: str) -> None:
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
def test_files_of_rosdistro_become_an_index(packed: bool, tmp_path: Path) -> None:
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


def test_an_index_is_read_from_a_url(tmp_path: Path) -> None:
    address = Path(_upstream(tmp_path)).as_uri()
    assert {source.cache for source in upstream.sources(address).values()} == {(tmp_path / "cache.yaml").as_uri()}
    assert len(list(upstream.packages(upstream.sources(address)["jazzy"]))) == 9


def test_a_second_refresh_prints_the_numbers_of_changed_lines(tmp_path: Path) -> None:
    source = _upstream(tmp_path / "up")
    command.refresh(source, ["jazzy"], str(tmp_path), date="2026-09-01")
    file = tmp_path / "up/jazzy/distribution.yaml"
    file.write_text(file.read_text().replace("1.2.3-4", "1.2.4-1").replace("never:", "now:"))
    (written,) = command.refresh(source, ["jazzy"], str(tmp_path), date="2026-09-02")
    assert (written.added, written.removed, written.changed) == (1, 1, 2)
    assert str(written) == f"{tmp_path}/jazzy.idx: 9 lines, 1 added, 1 removed, 2 changed"


def test_a_new_folder_has_no_removed_lines(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "prefix").mkdir()
    options = {"action": "scan", "prefixes": [str(tmp_path / "prefix")], "distro": "humble", "to": str(tmp_path / "new")}
    command.run(options)
    assert "removed" not in capsys.readouterr().out.replace("0 removed", "")


def test_the_command_prints_the_files_that_it_wrote(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = {"action": "refresh", "source": _upstream(tmp_path / "up"), "distro": ["jazzy"], "rosdep": [], "to": ""}
    assert command.run(options) == 0
    assert "ros-lint/index/jazzy.idx: 9 lines" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("file", "content", "says"),
    [
        ("index-v4.yaml", None, "cannot be read"),
        ("index-v4.yaml", "distributions: [", "is not valid YAML"),
        ("index-v4.yaml", "[]", "has no mapping 'distributions'"),
        ("index-v4.yaml", "distributions: {jazzy: 1}", "distribution 'jazzy' has no list of files"),
        ("index-v4.yaml", "distributions: {jazzy: {distribution: []}}", "has no cache for 'jazzy'"),
        ("cache.yaml", None, "cannot be read"),
        ("cache.yaml", "\x1f\x8b", "cannot be read"),
        ("cache.yaml", "{}", "has no mapping 'release_package_xmls'"),
        ("cache.yaml", "{release_package_xmls: 3}", "has no mapping 'release_package_xmls'"),
        ("jazzy/distribution.yaml", None, "cannot be read"),
        ("jazzy/distribution.yaml", "{repositories: []}", "has no mapping 'repositories'"),
    ],
)
def test_an_unreadable_source_is_reported_and_keeps_the_old_data(
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
    output = capsys.readouterr().err
    assert output.startswith("ros-lint: ")
    assert says in output
    assert [path.name for path in to.iterdir()] == ["jazzy.idx"]
    assert (to / "jazzy.idx").read_text() == EXPECTED


def test_an_unknown_distribution_is_reported_with_the_available_ones(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = {"action": "refresh", "source": _upstream(tmp_path), "distro": ["jazy"], "rosdep": [], "to": str(tmp_path)}
    assert command.run(options) == 2
    assert "has no distribution 'jazy'; available: foxy, jazzy, noetic" in capsys.readouterr().err


def test_only_file_and_http_urls_are_read() -> None:
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


def test_rosdep_rules_resolve_as_in_rosdep() -> None:
    """What rosdep's own resolver says of these rules (REP 111), written down."""
    result = rosdep_rules.keys([("osx", {"only_osx": {"osx": {}}, "both": {"osx": {"homebrew": {"packages": ["q"]}}}}),
                               ("base", {**yaml.safe_load(RULES), "both": {"ubuntu": ["b"]}}),
                               ("python", {"apt_everywhere": {"fedora": ["late"]}})])  # fmt: skip
    lines = {name: rosdep.render(key).split("\t")[1:] for name, key in result.items()}
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
    with pytest.raises(KnowledgeError, match="not a file of rosdep rules"):
        rosdep_rules.keys([("x", [])])
    with pytest.raises(KnowledgeError, match="rule of 'a' is not a mapping"):
        rosdep_rules.keys([("x", {"a": "b"})])


def test_rosdep_rules_are_refreshed_with_an_index(tmp_path: Path) -> None:
    (tmp_path / "rules.yaml").write_text(RULES)
    written = command.refresh(
        _upstream(tmp_path / "up"), ["jazzy"], str(tmp_path / "to"), [str(tmp_path / "rules.yaml")], "2026-09-01"
    )
    assert [Path(entry.path).name for entry in written] == ["jazzy.idx", "rosdep.tsv"]
    assert Knowledge("jazzy", [str(tmp_path / "to")]).resolves("by_version") is False


def test_the_command_line_runs_the_command(tmp_path: Path) -> None:
    to = str(tmp_path)
    words = [sys.executable, "-m", "ros_lint", "index", "refresh", "--from", _upstream(tmp_path), "--distro", "jazzy", "--to", to]
    process = subprocess.run(words, capture_output=True, text=True, check=True)
    assert process.stdout.startswith(f"{to}/jazzy.idx: 9 lines")
    assert (tmp_path / "jazzy.idx").read_text().splitlines()[1:] == EXPECTED.splitlines()[1:]
