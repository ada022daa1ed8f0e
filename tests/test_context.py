"""Packages around the requested ones: they are read, and nothing is reported or fixed in them."""

import json
import os
import shutil
from pathlib import Path
from typing import Any

import pytest

from ros_lint.cli.context import context_of, requested_folder
from ros_lint.cli.main import main
from tests.packages import manifest_text

CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
find_package({needs} REQUIRED)
add_executable(node node.cpp)
target_link_libraries(node {needs}::{needs})
install(TARGETS node DESTINATION lib/${{PROJECT_NAME}})
ament_package()
"""
TOOL = "<buildtool_depend>ament_cmake</buildtool_depend>"


def write_package(folder: Path, name: str, needs: str, *depends: str) -> None:
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(manifest_text(name, [TOOL, *depends]), "utf-8")
    (folder / "CMakeLists.txt").write_text(CMAKE.format(name=name, needs=needs), "utf-8")
    (folder / "node.cpp").write_text(f"#include <{needs}/x.hpp>\nint main() {{ {needs}::f(); }}\n", "utf-8")


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A repository in which gripper needs arm_core, a sibling package, without declaring it."""
    root = tmp_path / "repository"
    write_package(root / "gripper", "gripper", "arm_core")
    write_package(root / "wrist", "wrist", "arm_core")
    write_package(root / "arm_core", "arm_core", "rclcpp", "<depend>rclcpp</depend>")
    (root / ".git").mkdir()
    return root


def report(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> Any:
    main([*map(str, arguments), "--format", "json", "--no-cache", "--distro", "jazzy"])
    return json.loads(capsys.readouterr().out)


def of_package(document: Any, *names: str) -> list[Any]:
    return [finding for finding in document["findings"] if finding["package"] in names]


def test_a_package_alone_has_the_findings_that_it_has_in_the_workspace(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    everything = report(capsys, repository)
    alone = report(capsys, repository / "gripper")
    assert "arm_core" in [finding["subject"] for finding in alone["findings"]]
    assert alone["findings"] == of_package(everything, "gripper")
    assert (alone["packages"], alone["context_packages"]) == (1, 2)
    assert report(capsys, repository / "gripper", "--no-context")["findings"] != alone["findings"]


def test_several_paths_and_files_of_packages(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    everything = report(capsys, repository)
    two = report(capsys, repository / "gripper" / "node.cpp", repository / "wrist" / "package.xml", repository / "wrist")
    assert two["findings"] == of_package(everything, "gripper", "wrist")
    assert (two["packages"], two["context_packages"]) == (2, 1)
    nested = report(capsys, repository, repository / "gripper")
    assert nested["findings"] == everything["findings"]
    assert nested["context_packages"] == 0


def test_a_rejected_manifest_is_reported_if_it_was_asked_for(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    manifest = manifest_text("wrist", [TOOL, "<run_depend>arm_core</run_depend>"])
    (repository / "wrist" / "package.xml").write_text(manifest, "utf-8")
    for folder in (repository, repository / "wrist"):
        assert [finding["rule"] for finding in report(capsys, folder)["findings"]].count("rejected-manifest") == 1
    assert of_package(report(capsys, repository / "gripper"), "wrist") == []


def test_fixes_change_only_what_was_asked_for(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (repository / "wrist" / "package.xml").read_text("utf-8")
    main([str(repository / "gripper"), "--fix", "--no-cache", "--distro", "jazzy"])
    assert "Checked 1 of 3 packages; the others are context." in capsys.readouterr().out
    assert "<depend>arm_core</depend>" in (repository / "gripper" / "package.xml").read_text("utf-8")
    assert (repository / "wrist" / "package.xml").read_text("utf-8") == before


def test_a_cached_report_depends_on_the_context(
    repository: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    request = [str(repository / "gripper"), "--format", "json", "--distro", "jazzy"]
    main(request)
    first = capsys.readouterr().out
    main(request)
    assert capsys.readouterr().out == first
    shutil.rmtree(repository / "arm_core")
    main(request)
    assert capsys.readouterr().out != first


def test_an_ignored_package_is_checked_alone(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_package(repository / "old" / "claw", "claw", "arm_core")
    (repository / "old" / "COLCON_IGNORE").touch()
    assert report(capsys, repository / "old" / "claw")["context_packages"] == 0


def test_the_context_is_the_repository_or_the_workspace_around_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "ws" / "src" / "group" / "p"
    write_package(package, "p", "rclcpp")
    assert context_of(str(package)) == str(package)
    (tmp_path / "ws" / "install").mkdir()
    assert context_of(str(package)) == str(tmp_path / "ws")
    assert context_of(str(package.parent)) == str(tmp_path / "ws")
    assert context_of(str(tmp_path / "ws")) == str(tmp_path / "ws")
    assert context_of(str(tmp_path / "ws" / "src")) == str(tmp_path / "ws" / "src")
    monkeypatch.setenv("HOME", str(tmp_path / "ws"))
    assert context_of(str(package)) == str(package)
    monkeypatch.setenv("HOME", "/nowhere")
    (package / ".git").mkdir()
    assert context_of(str(package)) == str(package)


def test_a_path_in_a_package_means_the_package(tmp_path: Path) -> None:
    package = tmp_path / "p"
    write_package(package, "p", "rclcpp")
    (package / "include" / "p").mkdir(parents=True)
    for path in (package, package / "include" / "p", package / "node.cpp", package / "package.xml"):
        assert requested_folder(str(path)) == str(package)
    write_package(package / "test" / "workspace" / "q", "q", "rclcpp")
    (package / "test" / "workspace" / "q" / "COLCON_IGNORE").touch()
    assert requested_folder(str(package / "test" / "workspace")) == str(package)
    os.remove(package / "test" / "workspace" / "q" / "COLCON_IGNORE")
    assert requested_folder(str(package / "test" / "workspace")) == str(package / "test" / "workspace")
    (tmp_path / "notes.txt").touch()
    assert requested_folder(str(tmp_path / "notes.txt")) == ""


def test_paths_of_text_are_relative_to_the_current_folder(
    repository: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def paths(form: str, *arguments: str | Path) -> set[str]:
        main([*map(str, arguments), "--format", form, "--no-cache", "--distro", "jazzy", "--quiet"])
        lines = capsys.readouterr().out.splitlines()
        if form == "text":
            return {line.strip().removeprefix("--> ").partition(":")[0] for line in lines if line.strip().startswith("--> ")}
        return {line.partition(":")[0] for line in lines}

    files = {f"{package}/CMakeLists.txt" for package in ("gripper", "wrist")}
    for folder, expected in (
        (repository, files),
        (repository / "gripper", {"CMakeLists.txt", "../wrist/CMakeLists.txt"}),
        (repository.parent, {f"repository/{file}" for file in files}),
        (Path("/"), {f"{str(repository)[1:]}/{file}" for file in files}),
    ):
        monkeypatch.chdir(folder)
        for form in ("text", "concise"):
            shown = paths(form, repository)
            assert expected <= shown
            assert all((folder / path).is_file() for path in shown)
    main([str(repository / "gripper" / "CMakeLists.txt"), "--format", "text", "--no-cache", "--distro", "jazzy"])
    assert "find_package(arm_core REQUIRED)" in capsys.readouterr().out
    (repository.parent / "elsewhere").mkdir()
    monkeypatch.chdir(repository.parent / "elsewhere")
    assert files <= paths("concise", repository)
    monkeypatch.chdir(repository / "gripper")
    assert {finding["path"] for finding in report(capsys, repository)["findings"]} >= files
