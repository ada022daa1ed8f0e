"""The packages for colcon and ament in integrations/, in workspaces with a planted bug."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from ros_lint import __version__

pytestmark = pytest.mark.slow

FOLDER = Path(__file__).parents[1] / "integrations"
DEBIAN_COLCON = Path("/usr/bin/colcon")
DEBIAN_AMENT = Path("/usr/share/ament_cmake_core/package.xml")
MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>1.0.0</version>
  <description>A package with a launch file that is not installed.</description>
  <maintainer email="dev@example.org">Dev</maintainer>
  <license>Apache-2.0</license>
  {depends}
  <export>
    <build_type>{build_type}</build_type>
  </export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(driver NONE)
find_package(ament_cmake REQUIRED)
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  ament_lint_auto_find_test_dependencies()
endif()
ament_package()
"""
SETUP = """from setuptools import setup

package_name = 'teleop'

setup(
    name=package_name,
    version='1.0.0',
    packages=[package_name],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    tests_require=['pytest'],
)
"""
PYTEST = """import pytest
from ament_ros_lint.main import main_with_findings


@pytest.mark.ros_lint
@pytest.mark.linter
def test_ros_lint():
    code, findings = main_with_findings([])
    assert code == 0, '\\n'.join(findings)
"""
LAUNCH = """from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription([])
"""


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Make a workspace with a package of CMake and one of Python, both with a launch file that is not installed."""
    depends = "<buildtool_depend>ament_cmake</buildtool_depend>\n  <exec_depend>launch</exec_depend>\n"
    linters = "  <test_depend>ament_lint_auto</test_depend>\n  <test_depend>ament_cmake_ros_lint</test_depend>"
    cmake = MANIFEST.format(name="driver", depends=depends + linters, build_type="ament_cmake")
    depends = "<exec_depend>launch</exec_depend>\n"
    linters = "  <test_depend>ament_ros_lint</test_depend>\n  <test_depend>python3-pytest</test_depend>"
    python = MANIFEST.format(name="teleop", depends=depends + linters, build_type="ament_python")
    source = tmp_path / "ws" / "src"
    (tmp_path / "ws" / "log").mkdir(parents=True)  # as after a build, so that the packages around are read
    write(source / "driver", {"package.xml": cmake, "CMakeLists.txt": CMAKE, "launch/driver.launch.py": LAUNCH})
    python_files = {
        "package.xml": python,
        "setup.py": SETUP,
        "setup.cfg": "[develop]\nscript_dir=$base/lib/teleop\n[install]\ninstall_scripts=$base/lib/teleop\n",
        "resource/teleop": "",
        "teleop/__init__.py": "",
        "test/test_ros_lint.py": PYTEST,
        "launch/teleop.launch.py": LAUNCH,
    }
    write(source / "teleop", python_files)
    for name in ("ament_ros_lint", "ament_cmake_ros_lint"):
        shutil.copytree(FOLDER / name, source / "linters" / name)
    return source.parent


def environment(tmp_path: Path, *folders: str) -> dict[str, str]:
    """Return an environment in which ros-lint is the only program that does not come from the given folders."""
    programs = tmp_path / "programs"
    programs.mkdir(exist_ok=True)
    link = programs / "ros-lint"
    if not link.exists():
        link.symlink_to(Path(sys.executable).parent / "ros-lint")
    kept = {key: value for key, value in os.environ.items() if key in ("HOME", "LANG", "TMPDIR")}
    return {**kept, "PATH": os.pathsep.join([str(programs), *folders]), "ROS_DISTRO": "jazzy"}


def run(command: list[str], folder: Path, variables: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=folder, env=variables, capture_output=True, text=True, timeout=300, check=False)


@pytest.mark.skipif(
    not (DEBIAN_COLCON.exists() and DEBIAN_AMENT.exists()), reason="Debian's colcon or ament-cmake is not installed"
)
def test_colcon_test_fails_until_the_bugs_are_fixed(workspace: Path, tmp_path: Path) -> None:
    variables = environment(tmp_path, "/usr/bin", "/bin")

    def build_and_test() -> subprocess.CompletedProcess[str]:
        for verb in ("build", "test"):
            process = run(["colcon", verb, "--event-handlers", "console_direct+"], workspace, variables)
            assert process.returncode == 0, process.stdout + process.stderr
        return run(["colcon", "test-result", "--verbose"], workspace, variables)

    result = build_and_test()
    assert result.returncode == 1, result.stdout
    for name in ("driver", "teleop"):
        assert re.search(rf"{name}.* warning: 'launch/' contains launch files .*\[uninstalled-launch\]", result.stdout), (
            result.stdout
        )
    fixed = run(["ros-lint", "src/driver", "src/teleop", "--fix"], workspace, variables)
    assert fixed.returncode == 0, fixed.stdout
    result = build_and_test()
    assert result.returncode == 0, result.stdout


def ament_ros_lint(*arguments: str, folder: Path, variables: dict[str, str]) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", "from ament_ros_lint.main import run; run()", *arguments]
    return run(command, folder, {**variables, "PYTHONPATH": str(FOLDER / "ament_ros_lint")})


def test_the_program_writes_an_xunit_file(workspace: Path, tmp_path: Path) -> None:
    variables = environment(tmp_path)
    target = tmp_path / "results" / "ros_lint.xunit.xml"
    process = ament_ros_lint("--xunit-file", str(target), folder=workspace / "src" / "driver", variables=variables)
    assert (process.returncode, process.stderr) == (1, "")
    assert re.fullmatch(r".*warning: 'launch/' contains .*\[uninstalled-launch\]\n", process.stdout)
    root = ElementTree.parse(target).getroot()
    assert (root.tag, root.get("failures"), root.get("errors")) == ("testsuite", "1", "0")
    ignored = ament_ros_lint("--ignore", "uninstalled-launch", folder=workspace / "src" / "driver", variables=variables)
    assert (ignored.returncode, ignored.stdout, ignored.stderr) == (0, "", "")


def test_a_missing_program_is_an_error_and_no_result_remains(workspace: Path, tmp_path: Path) -> None:
    process = ament_ros_lint(folder=workspace, variables={"PATH": str(tmp_path)})
    assert (process.returncode, process.stdout) == (2, "the program 'ros-lint' is not installed, or not in PATH\n")
    target = tmp_path / "old.xml"
    target.write_text("<testsuite/>")
    options = ["--xunit-file", str(target), "--select", "no-such-rule"]
    process = ament_ros_lint(*options, folder=workspace, variables=environment(tmp_path))
    assert (process.returncode, target.exists()) == (2, False)


@pytest.fixture
def verb(tmp_path: Path) -> dict[str, str]:
    """Return an environment in which the entry points of colcon-ros-lint are installed."""
    shutil.copytree(FOLDER / "colcon-ros-lint", tmp_path / "extension")
    process = run([sys.executable, "setup.py", "-q", "egg_info"], tmp_path / "extension", environment(tmp_path))
    assert process.returncode == 0, process.stderr
    return {**environment(tmp_path), "PYTHONPATH": str(tmp_path / "extension"), "COLCON_HOME": str(tmp_path / "colcon")}


def colcon(*arguments: str, folder: Path, variables: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return run([sys.executable, "-m", "colcon", *arguments], folder, variables)


def test_the_verb_of_colcon_checks_the_selected_packages(workspace: Path, verb: dict[str, str]) -> None:
    process = colcon(
        "ros-lint", "--packages-select", "driver", "--ros-lint-args", "--format", "concise", folder=workspace, variables=verb
    )
    assert process.returncode == 1, process.stderr
    assert "src/driver" in process.stdout
    assert "src/teleop" not in process.stdout
    process = colcon("ros-lint", "--base-paths", "src/teleop", folder=workspace, variables=verb)
    assert (process.returncode, "src/teleop" in process.stdout, "src/driver" in process.stdout) == (1, True, False)
    process = colcon(
        "ros-lint",
        "--packages-skip",
        "driver",
        "teleop",
        "--ros-lint-args",
        "--select",
        "ROS401",
        folder=workspace,
        variables=verb,
    )
    assert process.returncode == 0, process.stdout


def test_event_handlers_receive_the_check_as_a_job(workspace: Path, verb: dict[str, str]) -> None:
    command = ("ros-lint", "--packages-select", "driver")
    process = colcon(*command, folder=workspace, variables=verb)
    assert (process.returncode, process.stdout.partition("\n")[0]) == (1, "Starting >>> ros-lint")
    assert "Failed   <<< ros-lint [" in process.stderr
    process = colcon(*command, "--event-handlers", "console_start_end-", folder=workspace, variables=verb)
    assert (process.returncode, process.stdout.partition(":")[0]) == (1, "driver")
    assert "Failed" not in process.stderr
    log = (workspace / "log" / "latest_ros-lint" / "logger_all.log").read_text("utf-8")
    assert "Invoking command in" in log


def test_colcon_finds_only_the_integrations_in_a_clone() -> None:
    """A clone of the repository in a workspace adds no package of the fixtures, which have cycles and duplicate names."""
    command = ["git", "ls-files", "--", "*package.xml", "*setup.py", "*CMakeLists.txt"]
    files = subprocess.run(command, cwd=FOLDER.parent, capture_output=True, text=True, check=True).stdout.split()
    folders = {path.partition("/")[0] for path in files}
    assert folders == {"fixtures", "integrations"}
    assert (FOLDER.parent / "fixtures" / "COLCON_IGNORE").exists()


def test_the_versions_are_that_of_ros_lint() -> None:
    manifests = [FOLDER / name / "package.xml" for name in ("ament_ros_lint", "ament_cmake_ros_lint")]
    assert {ElementTree.parse(path).findtext("version") for path in manifests} == {__version__}
    for name in ("ament_ros_lint/setup.py", "colcon-ros-lint/colcon_ros_lint/__init__.py"):
        assert f'version="{__version__}"' in (FOLDER / name).read_text("utf-8").replace("__version__ = ", "version=")


def test_the_packages_are_clean(tmp_path: Path) -> None:
    """They have no finding of ros-lint except for the rosdep key of ros-lint, which is not in the index yet."""
    process = run(["ros-lint", str(FOLDER), "--ignore", "unknown-dependency"], tmp_path, environment(tmp_path))
    assert process.returncode == 0, process.stdout
