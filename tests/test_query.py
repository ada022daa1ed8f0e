"""The workspace that a command queries if the command line names none."""

from pathlib import Path

import pytest

from ros_lint.cli.commands.query import current_workspace, enclosing_workspace


def test_the_enclosing_workspace_is_the_built_folder_the_repository_or_the_package(tmp_path: Path) -> None:
    launch_file = tmp_path / "ws" / "src" / "repo" / "p" / "launch" / "a.launch.py"
    launch_file.parent.mkdir(parents=True)
    launch_file.touch()
    package_folder = launch_file.parent.parent
    (package_folder / "package.xml").touch()
    assert enclosing_workspace(str(launch_file)) == str(package_folder)
    (tmp_path / "ws" / "install").mkdir()
    assert enclosing_workspace(str(launch_file)) == str(tmp_path / "ws")
    (package_folder.parent / ".git").mkdir()
    assert enclosing_workspace(str(launch_file)) == str(tmp_path / "ws")
    (tmp_path / "ws" / "install").rmdir()
    assert enclosing_workspace(str(launch_file)) == str(package_folder.parent)
    (package_folder.parent / ".git").rmdir()
    (tmp_path / "ws" / ".git").mkdir()
    assert enclosing_workspace(str(launch_file)) == str(tmp_path / "ws")


def test_the_current_workspace_is_that_of_the_package_around_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "ws" / "src" / "p"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").touch()
    (tmp_path / "ws" / "install").mkdir()
    for folder, result in ((package, tmp_path / "ws"), (package / "launch", tmp_path / "ws"), (tmp_path / "ws" / "src", ".")):
        monkeypatch.chdir(folder)
        assert current_workspace() == str(result)
