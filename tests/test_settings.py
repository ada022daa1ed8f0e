"""Settings: their order of precedence, validation and origins."""

import os
import re
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from ros_lint.cli import settings as config
from ros_lint.cli.options import OPTIONS, schema
from ros_lint.cli.settings import ConfigError, settle


def settings(
    folder: Path,
    text: str | None = None,
    *,
    name: str = "ros-lint.toml",
    said: dict[str, Any] | None = None,
    env: dict[str, str] | None = None,
) -> Any:
    if text is not None:
        (folder / name).write_text(text)
    return settle(said or {}, str(folder), env or {}, str(folder))


def test_the_command_line_overrides_the_file_and_the_file_the_environment(tmp_path: Path) -> None:
    env = {"ROS_DISTRO": "kilted"}
    assert settings(tmp_path, env=env)["distro"] == ("kilted",)
    assert settings(tmp_path, env=env).origin("distro") == "ROS_DISTRO"
    result = settings(tmp_path, 'distro = "humble"', env=env)
    assert (result["distro"], result.origin("distro")) == (("humble",), "ros-lint.toml")
    result = settings(tmp_path, env=env, said={"distro": ("jazzy",)})
    assert (result["distro"], result.origin("distro")) == (("jazzy",), "--distro")
    result = settings(tmp_path, env=env, said={"isolated": True})
    assert (result["distro"], result.origin("distro")) == ((), "default")


def test_the_nearest_file_with_settings_is_used(tmp_path: Path) -> None:
    inner = tmp_path / "ws" / "src"
    inner.mkdir(parents=True)
    (tmp_path / "pyproject.toml").write_text('[tool.ros-lint]\ndistro = "humble"\n')
    (tmp_path / "ws" / "pyproject.toml").write_text("[tool.ruff]\n")
    assert settle({}, str(inner), {})["distro"] == ("humble",)
    (inner / "ros-lint.toml").write_text('distro = "jazzy"')
    assert settle({}, str(inner), {})["distro"] == ("jazzy",)


def test_a_file_above_the_repository_is_not_used(tmp_path: Path) -> None:
    package = tmp_path / "repository/src/a"
    package.mkdir(parents=True)
    (tmp_path / "repository/.git").mkdir()
    above = tmp_path / "ros-lint.toml"
    above.write_text('distro = "humble"\n')
    result = settle({}, str(package), {})
    assert result["distro"] == ()
    assert result.warnings == (f"{above}: not used, because it is above {tmp_path / 'repository'}; use --config to use it",)
    assert settle({"config": str(above)}, str(package), {})["distro"] == ("humble",)
    (tmp_path / "repository/ros-lint.toml").write_text('distro = "jazzy"\n')
    result = settle({}, str(package), {})
    assert (result["distro"], result.warnings) == (("jazzy",), ())


def test_a_file_at_the_root_of_a_workspace_of_repositories_is_used(tmp_path: Path) -> None:
    (tmp_path / "src/repository/.git").mkdir(parents=True)
    (tmp_path / "ros-lint.toml").write_text('distro = "humble"\n')
    assert settle({}, str(tmp_path / "src/repository"), {})["distro"] == ()
    (tmp_path / "install").mkdir()  # colcon has built in it, so it is a workspace
    result = settle({}, str(tmp_path / "src/repository"), {})
    assert (result["distro"], result.warnings) == (("humble",), ())


def test_a_file_of_another_user_above_the_folder_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "a"
    folder.mkdir()
    above = tmp_path / "ros-lint.toml"
    above.write_text('distro = "humble"\n')
    mine = folder.stat().st_uid
    monkeypatch.setattr(os, "geteuid", lambda: mine)
    others = {str(above): mine + 1}
    for name in ("stat", "lstat"):
        monkeypatch.setattr(os, name, partial(_with_owner, getattr(os, name), others))
    result = settle({}, str(folder), {})
    assert result["distro"] == ()
    assert result.warnings == (f"{above}: not used, because it belongs to another user; use --config to use it",)
    others[str(folder)] = mine + 1  # a mounted workspace, for example
    assert settle({}, str(folder), {})["distro"] == ("humble",)
    others.clear()
    assert settle({}, str(folder), {})["distro"] == ("humble",)


def _with_owner(get: Callable[..., os.stat_result], others: Mapping[str, int], path: Any, **options: Any) -> os.stat_result:
    result = get(path, **options)
    fields = list(result)
    fields[4] = others.get(str(path), result.st_uid)
    return os.stat_result(fields)


def test_paths_in_a_file_are_relative_to_it(tmp_path: Path) -> None:
    assert settings(tmp_path, 'underlay = ["../install"]')["underlay"] == (str(tmp_path / "../install"),)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('\ndistor = "humble"', r"ros-lint.toml:2: unknown setting 'distor'; did you mean '?distro'?\?"),
        ('fail_on = "error"', r"ros-lint.toml:1: unknown setting 'fail_on'; did you mean '?fail-on'?\?"),
        (
            'fail-on = "eror"',
            r"ros-lint.toml:1: 'fail-on' must be one of error, warning, info, never, not 'eror'; did you mean '?error'?\?",
        ),
        ("pedantic = 1", "ros-lint.toml:1: 'pedantic' must be true or false"),
        ("jobs = -1", "ros-lint.toml:1: 'jobs' must be a whole number from 0 to 1000000"),
        (f"\njobs = {10**18}", "ros-lint.toml:2: 'jobs' must be a whole number from 0 to 1000000"),
        (f"jobs = 0x{'f' * 5000}", "ros-lint.toml:1: 'jobs' must be a whole number from 0 to 1000000"),
        (f"jobs = {'9' * 5000}", "ros-lint.toml(:1: 'jobs' must be a whole number|: a number has too many digits)"),
        (f"ignore = {'[' * 100_000}", "ros-lint.toml: nested too deep"),
        (f"ignore = {'{a = ' * 20_000}", "ros-lint.toml: nested too deep"),
        (f"\n{'a.' * 100_000}a = 1", "ros-lint.toml:2: a key has more than 50 parts"),
        ("#" * (257 << 10), "ros-lint.toml: 257 KB is more than the limit of 256 KB"),
        ('select = "all"', "ros-lint.toml:1: 'select' must be a list of strings"),
        ('[severity]\ndependency-cycle = "fatal"', "ros-lint.toml:1: 'severity' of 'dependency-cycle' must be one of"),
        ('[per-path-ignores]\n"src/*" = "all"', "ros-lint.toml:1: 'per-path-ignores' must map patterns to lists"),
        ('format = "json"', "ros-lint.toml:1: 'format' is a command-line option"),
        ("distro = 1", "ros-lint.toml:1: 'distro' must be a string or a list of strings"),
        ('distro = ["humble", 1]', "ros-lint.toml:1: 'distro' must be a string or a list of strings"),
        ("distro = oops", r"ros-lint.toml: .*line 1"),
    ],
)
def test_an_invalid_setting_is_reported_with_its_place(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        settings(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("tool = 1", "pyproject.toml: tool is not a table"),
        ("tool.ros-lint = 1", "pyproject.toml: tool.ros-lint is not a table"),
        ("[[tool]]", "pyproject.toml: tool is not a table"),
    ],
)
def test_a_pyproject_with_values_in_place_of_tables_is_an_error(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "pyproject.toml").write_text(text)
    with pytest.raises(ConfigError, match=message):
        settings(tmp_path, said={"config": str(tmp_path / "pyproject.toml")})
    text += '\nx = """\n[tool.ros-lint]\n"""'  # found without being asked for
    with pytest.raises(ConfigError, match=message):
        settings(tmp_path, text, name="pyproject.toml")


def test_a_pyproject_is_searched_in_linear_time(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text("\n" * 200_000)
    began = time.process_time()
    assert settings(tmp_path)["distro"] == ()
    assert time.process_time() - began < 1


def test_a_large_pyproject_is_an_error_only_if_it_has_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = f"[tool.ruff]\n{'#' * (256 << 10)}\n"
    assert settings(tmp_path, text, name="pyproject.toml")["distro"] == ()
    with pytest.raises(ConfigError, match=r"pyproject.toml: .* is more than the limit of 256 KB"):
        settings(tmp_path, f"{text}[tool.ros-lint]\n", name="pyproject.toml")
    monkeypatch.setattr(config, "_MOST_SEARCHED", len(text))
    assert settings(tmp_path)["distro"] == ()


@pytest.mark.parametrize("value", ["true", "false", "1"])
def test_a_file_cannot_enable_plugins(tmp_path: Path, value: str) -> None:
    result = settings(tmp_path, f'distro = "humble"\nplugins = {value}\n')
    assert (result["plugins"], result.origin("plugins"), result["distro"]) == (False, "default", ("humble",))
    place = f"{tmp_path}/ros-lint.toml:2"
    assert result.warnings == (f"{place}: 'plugins' has no effect in a configuration file, because it loads code; use --plugins",)
    result = settings(tmp_path, said={"plugins": True})
    assert (result["plugins"], result.origin("plugins")) == (True, "--plugins")
    assert "plugins" not in schema()["properties"]


def test_a_missing_configuration_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="nowhere.toml: no such configuration file"):
        settings(tmp_path, said={"config": "nowhere.toml"})


def test_the_schema_accepts_the_same_settings_as_the_table_of_options() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.Draft7Validator.check_schema(schema())
    validator = jsonschema.Draft7Validator(schema())
    good = {"distro": "humble", "select": ["all"], "severity": {"ROS2": "off"}, "per-path-ignores": {"a": ["all"]}, "jobs": 2}
    assert not list(validator.iter_errors(good))
    assert not list(validator.iter_errors({"distro": ["humble", "jazzy"]}))
    for bad in (
        {"distor": "x"},
        {"fail-on": "eror"},
        {"jobs": -1},
        {"jobs": 10**18},
        {"pedantic": 1},
        {"distro": 1},
        {"distro": ["humble", 1]},
        {"severity": {"a": "fatal"}},
        {"format": "json"},
    ):
        assert list(validator.iter_errors(bad)), bad


def test_show_settings_is_toml_with_origins(tmp_path: Path) -> None:
    import sys

    shown = settings(tmp_path, 'distro = "humble"').show()
    assert re.search(r'^distro += \["humble"\]  # ros-lint.toml$', shown, re.MULTILINE)
    if sys.version_info >= (3, 11):
        import tomllib

        assert set(tomllib.loads(shown)) == {option.name for option in OPTIONS}
