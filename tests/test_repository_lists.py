"""Files that list repositories, and submodules that are not cloned."""

from __future__ import annotations

from ros_lint.base.tree import MemoryTree
from ros_lint.workspace.discovery import repository_lists


def test_repository_lists_are_found_near_the_top_and_in_packages() -> None:
    names = ["a.repos", "src/deps.repos", "src/arm/arm.rosinstall", "tools/ci/x.repos", ".gitmodules", "b.txt"]
    tree = MemoryTree(dict.fromkeys(names, ""))
    assert repository_lists.find_lists(tree, ["src"], ["src/deep/er/z.repos", "src/deep/er/z.cpp"]) == (
        ".gitmodules", "a.repos", "src/arm/arm.rosinstall", "src/deep/er/z.repos", "src/deps.repos"
    )  # fmt: skip
    assert repository_lists.find_lists(MemoryTree({}), ["nowhere"], []) == ()


def test_expected_repositories_are_read_from_lists() -> None:
    repos = "repositories:\n  laser_tools:\n    type: git\n    url: https://example.com/x.git\n  'core/arm':\n    version: main\n"
    install = "- git: {local-name: src/camera, uri: 'https://example.com/y.git'}\n- git:\n    local-name: 'base'\n"
    tree = MemoryTree({"a.repos": repos, "b.rosinstall": install, ".gitmodules": "[submodule]\n  path = z\n"})
    repositories = repository_lists.expected_repositories(
        tree, ["a.repos", "b.rosinstall", ".gitmodules", "gone.repos"], ["z", "src/legs"]
    )
    assert repositories == ({"z", "legs"}, {"laser_tools", "arm", "camera", "base"})
