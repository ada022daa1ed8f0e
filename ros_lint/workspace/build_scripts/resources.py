"""Resource files of a package, which are looked up at run time: parameters, models, maps and so on."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ros_lint.base.auxiliary_files import is_auxiliary
from ros_lint.base.paths import folders_of, parent
from ros_lint.base.text import to_bytes

_FOLDERS = frozenset(
    {
        "behavior_trees", "behaviors", "calibration", "cfg", "config", "configs", "controllers", "data", "description",
        "maps", "map", "media", "meshes", "mesh", "model", "models", "param", "params", "protos", "rviz", "rviz2", "robots",
        "textures", "trees", "urdf", "sdf", "world", "worlds", "xacro", "images", "proto", "srdf",
    }
)  # fmt: skip
_FILES = re.compile(
    r"\.(?:ya?ml|rviz|urdf|xacro|sdf|worlds?|wbt|stl|dae|obj|pgm|png|jpe?g|xml|json|lua|srdf|config|proto|csv|onnx|sh|py|txt)\Z",
    re.IGNORECASE,
)


_OF_EXPORTER = re.compile(r"/joint_names_[\w.-]+\.yaml\Z")
"""Matches files for ROS 1 controllers that the SolidWorks exporter writes next to a URDF. ROS 2 never reads these files."""


def uninstalled_resources(files: Iterable[str], sources: Iterable[str]) -> dict[str, list[str]]:
    """Return the outermost resource folders without any installed file, each with its resource files.

    A resource folder has a usual name such as ``config``, ``urdf`` or ``maps``. ``files`` are the files of the package,
    ``sources`` its installed files. All paths are relative to the package.
    """
    # Few folders have many files, so each folder is examined once.
    source_folders = {parent(source) for source in sources}
    occupied = source_folders.union(*[folders_of(folder) for folder in source_folders])
    resources: dict[str, list[str]] = {}
    for file in files:
        top, _, below = file.partition("/")
        top = top.lower()
        if not (top in _FOLDERS or (top == "launch" and file.endswith(".launch"))) or not below:
            continue
        if not (_FILES.search(file) or file.endswith(".launch")) or file.endswith("/CMakeLists.txt") or is_auxiliary(file):
            continue
        if "/." in file or _OF_EXPORTER.search(file):  # hidden: private files of an editor or a tool
            continue
        free = [folder for folder in folders_of(file) if folder not in occupied]
        if free:
            resources.setdefault(free[-1], []).append(file)
    return resources


_MAY_NAME = (
    ".py", ".launch", ".xml", ".yaml", ".yml", ".urdf", ".xacro", ".sdf", ".world", ".wbt", ".proto", ".cpp", ".hpp", ".cc",
    ".h",
)  # fmt: skip


def may_name(file: str) -> bool:
    """Return whether a file is of a type that may look up resource files: a program, a launch file, a model, parameters."""
    name = file.rpartition("/")[2]
    return file.endswith(_MAY_NAME) and name not in ("package.xml", "setup.py") and not is_auxiliary(file)


def pattern_of(file: str) -> re.Pattern[bytes]:
    """Return a pattern that finds a look-up of a resource file by folder and name: ``config/a`` or ``"config", "a"``.

    The pattern does not match ``/home/me/config/a``: a path with more folders in front needs no installation.
    """
    folder, _, name = file.rpartition("/")
    last_folder = folder.rpartition("/")[2]
    words = (re.escape(to_bytes(last_folder)), re.escape(to_bytes(name)))
    return re.compile(rb"(?<![\w-])(?<![\w.~-]/)%s[\"'/, \t\r\n)(]{1,24}(%s)(?![\w-])" % words)
