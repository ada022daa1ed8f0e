"""The command line: exit codes, formats, settings, fixes and hooks."""

import gc
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

import pytest

from ros_lint import __version__
from ros_lint.cli.arguments import parse
from ros_lint.cli.main import main
from ros_lint.cli.options import COMMANDS
from ros_lint.reporters import FORMATS
from tests.packages import manifest_text

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
DEMO = ROOT / "fixtures" / "workspaces" / "demo"
HEADLINES = {
    "dependency-cycle",
    "undeclared-dependency",
    "unused-dependency",
    "uninstalled-launch",
    "launch-unknown-executable",
    "launch-outside-closure",
}


def run(*arguments: str | Path, cwd: Path = ROOT, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "ros_lint", *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, encoding="utf-8", cwd=cwd, env={**os.environ, **(env or {})}, check=False
    )


def findings(*arguments: str | Path) -> list[str]:
    """Return the lines that are findings, without the summary."""
    return [line for line in run(*arguments, "--format", "concise").stdout.splitlines() if line.endswith("]")]


@pytest.fixture
def demo(tmp_path: Path) -> Path:
    return Path(shutil.copytree(DEMO, tmp_path / "ws"))


@pytest.fixture
def clean(demo: Path) -> Path:
    """The demo with one package in which nothing is wrong."""
    for name in ("rover_driver", "rover_teleop", "rover_mission", "rover_bringup"):
        shutil.rmtree(demo / "src" / name)
    return demo


def test_the_demo_has_every_kind_of_headline(demo: Path) -> None:
    process = run(demo, "--format", "json")
    assert process.returncode == 1
    assert {finding["rule"] for finding in json.loads(process.stdout)["findings"]} == HEADLINES
    assert len(json.loads(process.stdout)["findings"]) == len(HEADLINES)


@pytest.mark.parametrize("form", FORMATS)
def test_exit_codes_do_not_depend_on_the_format(demo: Path, clean: Path, tmp_path: Path, form: str) -> None:
    (tmp_path / "empty").mkdir()
    assert run(DEMO, "--format", form).returncode == 1
    assert run(clean, "--format", form).returncode == 0
    assert run(tmp_path / "empty", "--format", form).returncode == 2
    assert run(tmp_path / "nowhere", "--format", form).returncode == 2


@pytest.mark.parametrize(("arguments", "code"), [(["--fail-on", "error"], 0), (["--fail-on", "never"], 0), ([], 1)])
def test_the_exit_code_depends_on_fail_on(demo: Path, arguments: Sequence[str], code: int) -> None:
    assert run(demo, "--select", "unused-dependency", *arguments).returncode == code


def test_version_and_help_are_printed() -> None:
    assert run("--version").stdout == f"ros-lint {__version__}\n"
    shown = run("--help")
    assert shown.returncode == 0
    for command in COMMANDS:
        assert f"  {command} " in shown.stdout
        assert run(command, "--help").returncode == 0
    assert "Print the JSON schema of the configuration file.\n" in run("schema", "--help").stdout


HEAVY = {"networkx", "libcst", "lxml", "yaml", "importlib.metadata", "dataclasses", "json", "argparse"}


@pytest.mark.parametrize(
    ("arguments", "allowed"),
    [
        (["--version"], set()),
        (["--help"], {"argparse"}),
        (["CLEAN", "--format", "concise"], {"argparse", "lxml"}),
        (["CLEAN", "--format", "concise", "--ignore", "manifest-schema"], {"argparse"}),
    ],
)
def test_slow_modules_are_imported_only_if_needed(clean: Path, arguments: list[str], allowed: set[str]) -> None:
    given = [str(clean) if argument == "CLEAN" else argument for argument in arguments]
    code = (
        "import sys\nfrom ros_lint.cli.main import main\ntry:\n    main(sys.argv[1:])\nexcept SystemExit:\n    pass\n"
        "print('\\n'.join(sys.modules), file=sys.stderr)"
    )
    process = subprocess.run([sys.executable, "-c", code, *given], capture_output=True, text=True, check=True)
    assert HEAVY & set(process.stderr.split()) <= allowed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--slect", "all"], r"unrecognized arguments: --slect all; did you mean '?--select'?\?"),
        (
            ["--select", "undeclared-dependancy"],
            r"unknown rule 'undeclared-dependancy'; did you mean '?undeclared-dependency'?\?",
        ),
        (["--ignore", "ROS507"], "rule 'ROS507' was divided into 'launch-missing-argument', "),
        (["--jobs", "-1"], "argument --jobs: must be a whole number from 0 to 1000000, not '-1'"),
        (["--exit-zero"], r"unrecognized arguments: --exit-zero; use --fail-on never \(see ros-lint --help\)"),
        (["--output-format=json"], r"unrecognized arguments: --output-format=json; use --format \(see ros-lint --help\)"),
        (["--frobnicate"], r"unrecognized arguments: --frobnicate \(see ros-lint --help\)"),
        (["--package-select", "a"], r"did you mean '--packages-select'\?"),
        (["--distro", "jazy"], r"--distro: unknown distribution 'jazy'; did you mean '?jazzy'?\? \(available: humble, "),
        (["--distro", "foxy"], r"--distro: end-of-life distribution 'foxy' \(available: humble, "),
        (["chek"], r"chek: no such file or directory; did you mean the command 'check'\?"),
        (["--format", "xml"], "argument --format: invalid choice: 'xml'"),
        (["--config", "nowhere.toml"], "nowhere.toml: no such configuration file"),
        (["--underlay", "nowhere"], "nowhere"),
    ],
)
def test_an_invalid_request_gives_a_message_and_exit_code_2(arguments: list[str], message: str) -> None:
    process = run(DEMO, *arguments)
    assert process.returncode == 2
    assert re.search(message, process.stderr)
    assert process.stdout == ""


@pytest.mark.parametrize("command", ["launch", "why"])
def test_an_error_of_a_command_names_its_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parse([command])
    assert f"(see ros-lint {command} --help)" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ('select = ["unusd-dependency"]', "select"),
        ('ignore = ["unusd-dependency"]', "ignore"),
        ('severity = {"unusd-dependency" = "off"}', "severity"),
        ('per-path-ignores = {"a" = ["unusd-dependency"]}', "per-path-ignores"),
    ],
)
def test_an_unknown_rule_in_a_file_is_reported_with_the_file_and_the_setting(clean: Path, text: str, name: str) -> None:
    (clean / "ros-lint.toml").write_text(text)
    process = run(clean)
    assert process.returncode == 2
    assert process.stderr.startswith(f"ros-lint: ros-lint.toml:1: {name}: unknown rule 'unusd-dependency'; did you mean ")


def test_the_distribution_is_chosen_by_option_file_environment_or_default(demo: Path) -> None:
    assert " for lyrical (assumed: newest LTS; set with --distro)" in run(demo).stdout
    assert " for humble (ROS_DISTRO)" in run(demo, env={"ROS_DISTRO": "humble"}).stdout
    assert " for kilted (--distro)" in run(demo, "--distro", "kilted", env={"ROS_DISTRO": "humble"}).stdout
    (demo / "ros-lint.toml").write_text('distro = "jazzy"')
    assert " for jazzy (ros-lint.toml)" in run(demo, env={"ROS_DISTRO": "humble"}).stdout


@pytest.mark.parametrize("arguments", [(), ("--fix",), ("why", "rover_driver", "rclcpp", "-C")])
def test_an_environment_with_a_distribution_without_data_is_an_error(demo: Path, arguments: tuple[str, ...]) -> None:
    process = run(*arguments, demo, env={"ROS_DISTRO": "foxy"})
    assert process.returncode == 2
    assert process.stderr.startswith("ros-lint: ROS_DISTRO: end-of-life distribution 'foxy' (available: humble, ")
    assert process.stderr.endswith("; pass --distro\n")


def test_patterns_that_match_no_file_are_reported(demo: Path) -> None:
    (demo / "ros-lint.toml").write_text(
        'exclude = ["rover_driver",\n  "rover_drivr"]\n[per-path-ignores]\n"src/**" = ["ROS201"]\n"srv/**" = ["ROS201"]\n'
    )
    warnings = [
        "ros-lint: ros-lint.toml:2: exclude: the pattern 'rover_drivr' matches no file",
        "ros-lint: ros-lint.toml:5: per-path-ignores: the pattern 'srv/**' matches no file",
    ]
    assert run(".", cwd=demo).stderr.splitlines() == warnings
    assert run(".", cwd=demo).stderr.splitlines() == warnings, "also from the cache"
    assert "matches no file" not in run("src/rover_teleop", cwd=demo).stderr, "the patterns may match elsewhere"


def test_a_package_checked_without_its_siblings_gives_a_warning(demo: Path) -> None:
    alone = run("src/rover_driver", cwd=demo)
    assert "'src/rover_driver' was checked without its sibling packages; run 'ros-lint ." in alone.stderr
    assert "without its sibling" not in run("src/rover_driver", "--no-context", cwd=demo).stderr


def test_rules_are_selected_and_ignored(demo: Path) -> None:
    assert len(findings(demo, "--select", "ROS5")) == 2
    assert len(findings(demo, "--select", "unused-dependency,ROS103")) == 2
    assert len(findings(demo, "--ignore", "launch-outside-closure,ROS2")) == 3
    (demo / "ros-lint.toml").write_text(
        'ignore = ["ROS1"]\n[severity]\nunused-dependency = "error"\nlaunch-outside-closure = "off"\n'
        '[per-path-ignores]\n"rover_teleop" = ["all"]\n"*.cpp" = ["undeclared-dependency"]\n'
    )
    lines = findings(demo)
    assert len(lines) == 2
    assert "error: 'diagnostic_updater'" in lines[1]
    assert "ignored by per-path-ignores" in run(demo).stdout


def test_pedantic_shows_findings_of_lower_confidence(demo: Path) -> None:
    manifest = demo / "src" / "rover_driver" / "package.xml"
    text = manifest.read_text().replace("<depend>rclcpp</depend>", "<depend>rclcpp</depend><depend>of_the_house</depend>")
    manifest.write_text(text)
    assert len(findings(demo, "--pedantic")) > len(findings(demo))


def test_excluded_folders_are_not_read(demo: Path) -> None:
    assert json.loads(run(demo, "--exclude", "rover_*", "--format", "json").stdout)["packages"] == 0
    assert json.loads(run(demo, "--exclude", "src/rover_driver", "--format", "json").stdout)["packages"] == 4


def test_show_settings_prints_the_origin_of_each_setting(demo: Path) -> None:
    (demo / "ros-lint.toml").write_text("pedantic = true")
    shown = run(demo, "--show-settings", "--jobs", "3").stdout
    assert re.search("^pedantic += true  # ros-lint.toml$", shown, re.MULTILINE)
    assert re.search("^jobs += 3  # --jobs$", shown, re.MULTILINE)


def test_output_goes_to_a_file(demo: Path, tmp_path: Path) -> None:
    target = tmp_path / "out.sarif"
    process = run(demo, "--format", "sarif", "--output", target)
    assert (process.returncode, process.stdout) == (1, "")
    assert json.loads(target.read_text())["version"] == "2.1.0"
    assert run(demo, "--output", tmp_path / "no" / "such" / "folder").returncode == 2


@pytest.mark.parametrize(
    ("arguments", "env", "colored"),
    [
        ([], {}, False),
        (["--color", "always"], {"NO_COLOR": "1"}, True),
        ([], {"FORCE_COLOR": "1"}, True),
        ([], {"FORCE_COLOR": "1", "NO_COLOR": "1"}, False),
        (["--color", "never"], {"FORCE_COLOR": "1"}, False),
    ],
)
def test_colours_depend_on_option_environment_and_terminal(
    demo: Path, arguments: list[str], env: dict[str, str], colored: bool
) -> None:
    assert ("\x1b[" in run(demo, *arguments, env=env).stdout) is colored


def test_a_closed_pipe_prints_no_traceback(demo: Path) -> None:
    command = f"{sys.executable} -m ros_lint {demo} | head -n 1"
    process = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=ROOT, check=False)
    assert process.stderr == ""


def test_a_second_fix_changes_nothing(demo: Path) -> None:
    patch = run(demo, "--diff").stdout
    before = {path: path.read_bytes() for path in demo.rglob("*") if path.is_file()}
    process = run(demo, "--fix")
    assert "fixed 5 findings in 4 files" in process.stderr
    assert process.returncode == 1, "what is left is reported"
    changed = {path for path, data in before.items() if path.read_bytes() != data}
    assert {path.name for path in changed} == {"package.xml", "setup.py"}
    assert "nothing to fix" in run(demo, "--fix").stderr
    assert {path for path, data in before.items() if path.read_bytes() != data} == changed
    # The patch says the same as the fix: applied backwards it restores everything.
    subprocess.run(["patch", "-R", "-p1", "-s"], input=patch, text=True, cwd=demo, check=True)
    assert {path: path.read_bytes() for path in before} == before


def test_only_the_fixes_of_some_rules_are_applied_and_listed(demo: Path) -> None:
    process = run(demo, "--fix", "--fix-only", "ROS201", "--show-fixes")
    assert process.stderr.splitlines() == [
        "ros-lint: fixed 1 finding in 1 file",
        "  src/rover_driver/package.xml: declare 'sensor_msgs' as <depend> [undeclared-dependency]",
    ]
    assert "Fixable: 3 with --fix" in process.stdout
    process = run(demo, "--diff", "--fix-only", "undeclared")
    assert process.returncode == 2
    assert process.stderr.startswith("ros-lint: --fix-only: unknown rule 'undeclared'; did you mean 'undeclared-dependency'?")


def test_fixes_that_together_would_close_a_cycle(tmp_path: Path) -> None:
    manifest = (
        '<package format="3"><name>{0}</name><version>1.0.0</version><description>d</description>'
        '<maintainer email="a@robots.example">a</maintainer><license>Apache-2.0</license>'
        "<buildtool_depend>ament_cmake</buildtool_depend><export><build_type>ament_cmake</build_type></export></package>\n"
    )
    cmake = "cmake_minimum_required(VERSION 3.16)\nproject({0})\nfind_package(ament_cmake REQUIRED)\n{1}\nament_package()\n"
    for name, find in (("arm", "hand"), ("hand", "arm")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "package.xml").write_text(manifest.format(name))
        (tmp_path / name / "CMakeLists.txt").write_text(cmake.format(name, f"find_package({find} REQUIRED)"))
    process = run(tmp_path, "--fix", "--select", "undeclared-dependency")
    assert "fixed 1 finding in 1 file" in process.stderr
    assert "depends on this package itself" in process.stdout
    assert run("order", tmp_path).returncode == 0


@pytest.mark.parametrize(
    ("options", "declared"),
    [
        ((), {"nav_msgs"}),
        (("--unsafe-fixes",), {"nav_msgs", "gz_math_vendor"}),
        (("--distro", "jazzy"), {"nav_msgs", "gz_math_vendor"}),
        (("--distro", "humble"), {"nav_msgs"}),
    ],
)
def test_a_package_is_only_declared_for_a_distribution_that_has_it(
    tmp_path: Path, options: tuple[str, ...], declared: set[str]
) -> None:
    manifest = tmp_path / "package.xml"
    manifest.write_text(manifest_text("robot", ["<buildtool_depend>ament_cmake</buildtool_depend>"]))
    finds = "".join(f"find_package({name} REQUIRED)\n" for name in ("ament_cmake", "nav_msgs", "gz_math_vendor"))
    (tmp_path / "CMakeLists.txt").write_text(f"project(robot)\n{finds}ament_package()\n")
    run(tmp_path, "--isolated", "--fix", *options)
    assert set(re.findall("<depend>(.*)</depend>", manifest.read_text())) == declared


def test_findings_of_lower_confidence_are_fixed_only_if_shown(demo: Path) -> None:
    manifest = demo / "src" / "rover_driver" / "package.xml"
    text = manifest.read_text().replace("<depend>rclcpp</depend>", "<depend>rclcpp</depend><depend>of_the_house</depend>")
    manifest.write_text(text)
    run(demo, "--fix", "--select", "unused-dependency")
    assert "diagnostic_updater" not in manifest.read_text()
    assert "of_the_house" in manifest.read_text()
    run(demo, "--fix", "--unsafe-fixes", "--select", "unused-dependency")
    assert "of_the_house" not in manifest.read_text()


def test_the_graph_commands_print_their_output(demo: Path) -> None:
    process = run("order", demo)
    assert process.returncode == 1
    assert process.stdout.splitlines() == ["rover_interfaces", "rover_mission", "rover_teleop"]
    assert "no build order, because of a dependency cycle: rover_bringup, rover_driver" in process.stderr
    assert run("why", "rover_bringup", "rover_interfaces", "-C", demo).returncode == 0
    assert run("why", "rover_interfaces", "rover_bringup", "-C", demo).returncode == 1
    assert run("why", "rover_interface", "rover_bringup", "-C", demo).returncode == 2
    assert run("graph", demo).stdout.startswith("digraph")
    assert json.loads(run("graph", demo, "--format", "json", "--metrics").stdout)
    assert run("overlay", demo).returncode == 0
    assert run("order", demo / "src" / "nowhere").returncode == 2


def test_a_file_from_standard_input_is_checked_in_its_workspace(demo: Path) -> None:
    (demo / ".git").mkdir()
    manifest = demo / "src" / "rover_teleop" / "package.xml"
    text = manifest.read_text()
    changed = text.replace("</package>", "  <depend>nav_msg</depend>\n</package>")

    def check(text: str, form: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "ros_lint", "--stdin-filename", str(manifest), "--format", form, *arguments]
        return subprocess.run(command, input=text, capture_output=True, text=True, cwd=ROOT, check=False, timeout=60)

    def findings(text: str) -> set[str]:
        return {line for line in check(text, "concise").stdout.splitlines() if re.search(r" \[[a-z-]+\]$", line)}

    assert all("rover_teleop/package.xml:" in line for line in findings(changed)), "findings in other files are not shown"
    (line,) = findings(changed) - findings(text)
    assert line.endswith("write 'nav_msgs' [unknown-dependency]")
    assert check(changed, "concise").returncode == 1
    assert "<depend>nav_msg</depend>" in check(changed, "text").stdout, "the frame has the unsaved text"
    assert manifest.read_text() == text
    process = check(text, "text", "--fix")
    assert process.returncode == 2
    assert process.stderr == "ros-lint: --stdin-filename and --fix cannot be combined, because the file is not saved\n"


def test_a_watched_workspace_is_checked_after_each_change(clean: Path) -> None:
    command = [sys.executable, "-u", "-m", "ros_lint", "--watch", "--quiet", "--format", "concise", str(clean)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT) as process:
        stop = threading.Timer(60, process.kill)
        stop.start()
        try:
            assert process.stderr is not None
            assert process.stdout is not None
            assert "waiting for changes" in process.stderr.readline()
            manifest, settings = next(clean.glob("src/*/package.xml")), clean / "ros-lint.toml"
            manifest.write_text(manifest.read_text().replace("</package>", "  <depend>nav_msg</depend>\n</package>"))
            assert "write 'nav_msgs'" in process.stdout.readline()
            assert "waiting for changes" in process.stderr.readline()
            settings.write_text('ignore = ["unknown-dependency"]\n')
            assert "waiting for changes" in process.stderr.readline()
            settings.write_text("")
            assert "write 'nav_msgs'" in process.stdout.readline(), "the ignored finding is reported again"
            assert "waiting for changes" in process.stderr.readline()
            process.send_signal(signal.SIGINT)
            process.wait()
        finally:
            stop.cancel()
            process.kill()
    assert process.returncode == 1, "the code of the last run"
    assert run("--watch", "--fix", clean).returncode == 2


def test_rules_schema_and_completion_are_printed() -> None:
    assert "undeclared-dependency" in run("rules").stdout
    assert json.loads(run("rules", "--format", "json").stdout)
    assert "## Why it matters" in run("rule", "ROS201").stdout
    assert "did you mean 'undeclared-dependency'?" in run("rule", "undeclared").stderr
    assert run("rule", "undeclared").returncode == 2
    assert json.loads(run("schema").stdout)["properties"]["distro"]
    for shell, path in (("bash", "ros-lint.bash"), ("zsh", "_ros-lint"), ("fish", "ros-lint.fish")):
        assert run("completion", shell).stdout == (ROOT / "packaging" / "completions" / path).read_text("utf-8")


def test_the_pre_commit_hooks_check_the_whole_project() -> None:
    yaml = pytest.importorskip("yaml")
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    assert [hook["id"] for hook in hooks] == ["ros-lint", "ros-lint-new", "ros-lint-fix"]
    for hook in hooks:
        assert hook["always_run"]
        assert not hook["pass_filenames"]


def test_a_finding_that_a_fix_reveals_is_fixed_in_the_same_run(tmp_path: Path) -> None:
    package = tmp_path / "robot"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text(
        '<package format="3">\n  <name>robot</name>\n  <version>1.0.0</version>\n  <description>d</description>\n'
        '  <maintainer email="a@robots.example">a</maintainer>\n  <license>Apache-2.0</license>\n'
        "  <buildtool_depend>ament_cmake</buildtool_depend>\n"
        "  <export><build_type>ament_cmake</build_type></export>\n</package>\n"
    )
    (package / "CMakeLists.txt").write_text("project(robot)\nfind_package(ament_cmake REQUIRED)\n\nament_package()\n")
    (package / "launch" / "robot.launch.xml").write_text('<launch><node pkg="joy" exec="joy_node"/></launch>\n')
    arguments = ("--isolated", "--distro", "jazzy", "--fix")
    alone = run(tmp_path, *arguments, "--select", "uninstalled-launch")
    assert "fix skipped: it would cause a new finding: 'joy_node' of 'joy' is started here" in alone.stderr
    assert "fixed 2 findings in 2 files" in run(tmp_path, *arguments).stderr
    assert "install(DIRECTORY launch " in (package / "CMakeLists.txt").read_text()
    assert "<exec_depend>joy</exec_depend>" in (package / "package.xml").read_text()
    assert "nothing to fix" in run(tmp_path, *arguments).stderr


def test_a_caller_of_main_keeps_the_garbage_collector(capsys: pytest.CaptureFixture[str]) -> None:
    assert gc.isenabled()
    assert main(["rules"]) == 0
    assert capsys.readouterr().out
    assert gc.isenabled()
