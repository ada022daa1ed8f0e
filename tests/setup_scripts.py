"""A package with a setup.py, evaluated."""

from __future__ import annotations

from ros_lint.base.text import Text
from ros_lint.collectors.setup_py.evaluate import evaluate
from ros_lint.facts.build import BuildScript

FILES = {
    "package.xml": "<package/>",
    "resource/pkg": "",
    "pkg/__init__.py": "",
    "pkg/node.py": "def main(): pass\n",
    "pkg/sub/__init__.py": "",
    "pkg/sub/more.py": "",
    "pkg/data/no_package.py": "",
    "test/__init__.py": "",
    "test/test_a.py": "",
    "launch/a.launch.py": "",
    "launch/b_launch.xml": "",
    "launch/c.launch.yaml": "",
    "launch/sub/d.launch.py": "",
    "launch/.hidden": "",
    "config/x.yaml": "",
    "config/y.yml": "",
    "models/robot/model.sdf": "",
    "models/robot/meshes/m.stl": "",
    "models/world.sdf": "",
    "scripts/tool.py": "#!/usr/bin/env python3\n",
}

HEAD = """\
from setuptools import find_packages, setup
import glob as globs
import os
from glob import glob
package_name = 'pkg'
"""


def script(body: str, cfg: str | None = None, pyproject: str | None = None, head: str = HEAD) -> BuildScript:
    files = sorted(FILES)
    return evaluate(
        "pkg",
        "ws/pkg",
        files,
        Text("ws/pkg/setup.py", head + body),
        Text("ws/pkg/setup.cfg", cfg) if cfg is not None else None,
        Text("ws/pkg/pyproject.toml", pyproject) if pyproject is not None else None,
        frozenset({"scripts/tool.py"}),
    )
