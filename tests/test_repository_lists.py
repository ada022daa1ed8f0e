"""Files that list repositories, and submodules that are not cloned."""

from __future__ import annotations

from ros_lint.base.tree import MemoryTree
from ros_lint.engine import registry
from ros_lint.engine.check import ReportContext, check
from ros_lint.engine.selection import select
from ros_lint.reporters.summary import limits
from ros_lint.workspace.discovery import repository_lists
from ros_lint.workspace.loader import Loader
from ros_lint.workspace.target import TargetDistro
from tests.one_package import loaded
from tests.packages import manifest_text


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
        tree,
        ["a.repos", "b.rosinstall", ".gitmodules", "gone.repos"],
        ["z", "src/legs"],
        [("camera", "src/camera"), ("b", "base")],
    )
    assert repositories.uncloned == {"z", "legs", "laser_tools", "x", "arm"}
    assert repositories.listed == {"laser_tools", "x", "arm", "camera", "y", "base"}
    assert repositories.lists == (("a.repos", ("arm", "laser_tools")), (".gitmodules", ("z",)))


def test_a_repository_is_cloned_if_its_folder_or_a_package_of_its_name_exists() -> None:
    repos = "repositories:\n" + "".join(
        f"  {name}:\n    type: git\n    url: {url}\n    version: main\n"
        for name, url in (
            ("core/arm", "git@host:org/Arm-ROS.git"),
            ("lib", "https://host/org/lib/"),
            ("legs", "https://host/legs_ros"),
        )
    )
    tree = MemoryTree({"ws/deps.repos": repos, "ws/src/lib/x.txt": ""})

    def uncloned(*packages: tuple[str, str]) -> set[str]:
        return set(repository_lists.expected_repositories(tree, ["ws/deps.repos"], [], packages).uncloned)

    assert uncloned() == {"arm", "Arm-ROS", "legs", "legs_ros"}
    assert uncloned(("legs_ros", "ws/src/x")) == {"arm", "Arm-ROS"}
    assert uncloned(("hand", "ws/src/core/arm/hand")) == {"legs", "legs_ros"}


def test_packages_of_repositories_that_are_not_cloned_are_unknown() -> None:
    repos = "repositories:\n  Arm-Tools:\n    type: git\n    url: https://host/arm_drivers.git\n  rclcpp:\n    type: git\n"
    files = {"car/package.xml": manifest_text("car"), "a/b/c/deps.repos": repos}
    world = loaded(files).world
    names = ("arm_tools", "arm_tools_msgs", "arm_drivers", "arm", "arm_toolsy", "rclcpp")
    assert [world.resolution(name) for name in names] == ["unknowable"] * 3 + ["unknown"] * 2 + ["known"]
    cloned = {**files, "Arm-Tools/package.xml": manifest_text("arm_base")}
    assert loaded(cloned).world.resolution("arm_tools_msgs") == "unknown"


def test_any_package_may_be_in_a_repository_of_an_unreadable_list() -> None:
    class Locked(MemoryTree):
        def read(self, path: str) -> bytes:
            if path == "deps.repos":
                raise PermissionError(13, "Permission denied")
            return super().read(path)

    files = {"car/package.xml": manifest_text("car"), "deps.repos": "repositories:\n  arm:\n    type: git\n"}
    workspace = Loader(Locked(files), ("",), TargetDistro("humble", "test")).load()
    assert [workspace.world.resolution(name) for name in ("wheels", "rclcpp")] == ["unknowable", "known"]
    assert [unread.what for unread in workspace.not_checked] == ["deps.repos"]
    assert loaded(files).world.resolution("wheels") == "unknown"


def test_the_summary_names_repositories_that_are_not_cloned() -> None:
    def not_cloned(text: str, *others: str) -> str:
        files = {"car/package.xml": manifest_text("car"), "deps.repos": text, **dict.fromkeys(others, text)}
        rules = registry.load()
        report = check((loaded(files),), (), select(rules), ReportContext(rules, "", ("",), ()))
        return next((sentence for sentence in limits(report) if "cloned" in sentence), "")

    names = "".join(f"  {name}:\n    type: git\n" for name in ("legs", "arm", "rclcpp", "ament-cmake"))
    assert not_cloned(f"repositories:\n{names}") == (
        "Not cloned here: arm and legs (deps.repos). Their packages are unknown, not missing"
    )
    assert not_cloned(f"repositories:\n{names}", "humble.repos", "jazzy.repos") == (
        "Not cloned here: arm and legs (deps.repos and 2 other files). Their packages are unknown, not missing"
    )
    assert (
        not_cloned("repositories:\n  BehaviorTree.CPP:\n    type: git\n  rclcpp:\n    type: git\n  car:\n    type: git\n") == ""
    )


def test_a_declared_package_is_certainly_used_even_if_its_repository_is_not_cloned() -> None:
    files = {
        "deps.repos": "repositories:\n  arm_msgs:\n    type: git\n  tool:\n    type: git\n",
        "arm/package.xml": manifest_text("arm", ["<depend>arm_msgs</depend>"]),
        "car/package.xml": manifest_text("car", build_type="ament_python"),
        "car/setup.py": "from setuptools import setup\nsetup(name='car', packages=['car'])\n",
        "car/car/__init__.py": "from arm_msgs.msg import Pose\nimport tool\n",
    }
    (car,) = loaded(files).called("car")
    assert [(use.package, use.certain) for use in car.uses if use.via == "import"] == [("arm_msgs", True)]
