"""Random folders with everything that colcon looks at, right and wrong."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

from tests.packages import manifest_text

NAMES = ("a", "b", "c.d", "sp ace", "ü", ".hidden", "build", "Z")
PACKAGES = ("alpha", "beta", "gamma", "delta", "epsilon", "zeta")
META = (
    "dependencies: [{0}, {1}]",
    "build-dependencies: [{0}]",
    "run-dependencies: [{1}]",
    "test-dependencies: [{0}, x]",
)


def write_workspace(random: Random, base: Path) -> None:
    """Fill an empty folder."""
    folders = [base, *_folders(random, base, 0)]
    for folder in folders:
        for name, content in dict(_content(random)).items():
            target = folder / name
            if target.exists() or target.is_symlink():
                continue
            if content is None:
                target.mkdir()
            elif content == "dangling":
                target.symlink_to("nowhere")
            else:
                target.write_text(content, "utf-8")
    for _ in range(random.choice((0, 0, 1, 3))):
        link = random.choice(folders) / random.choice(("link", "0", "zz"))
        if not link.is_symlink():
            link.symlink_to(random.choice(folders))
    if random.random() < 0.2:
        (base / "colcon.meta").write_text(_meta(random, [str(folder.relative_to(base)) for folder in folders]), "utf-8")


def _folders(random: Random, parent: Path, depth: int) -> Iterator[Path]:
    for name in random.sample(NAMES, random.choice((0, 1, 2, 3) if depth else (2, 3, 4))):
        folder = parent / name
        folder.mkdir()
        yield folder
        if depth < 3:
            yield from _folders(random, folder, depth + 1)


def _content(random: Random) -> Iterator[tuple[str, str | None]]:
    yield "notes.txt", ""
    kind = random.random()
    if kind < 0.35:
        yield "package.xml", _manifest(random)
    elif kind < 0.38:
        yield "package.xml", None
    if random.random() < 0.3:
        yield "CMakeLists.txt", _cmake(random)
    if random.random() < 0.06:
        yield (
            "setup.py",
            random.choice(
                (
                    "from setuptools import setup\nsetup()\n",
                    "import os\n",
                    "from setuptools import setup\ncmdclass = {}\nsetup(cmdclass=cmdclass)",
                )
            ),
        )
        if random.random() < 0.8:
            yield "setup.cfg", _setup_cfg(random)
    if random.random() < 0.05:
        yield "helpers.cmake", f"find_package({random.choice(PACKAGES)})\n"
    if random.random() < 0.12:
        marker = random.choice(
            (
                "COLCON_IGNORE",
                "AMENT_IGNORE",
                "CATKIN_IGNORE",
                "_setup_util.py",
                "_order_isolated_packages.py",
                "manifest.xml",
            )
        )
        yield marker, random.choice(("", "", None, "dangling"))
    if random.random() < 0.08:
        yield "colcon.pkg", _colcon_pkg(random)


def _manifest(random: Random) -> str:
    name = random.choice(PACKAGES)
    others = [other for other in PACKAGES if other != name]
    tags = ("depend", "build_depend", "exec_depend", "test_depend", "doc_depend", "build_export_depend")
    lines = {f"<{random.choice(tags)}>{other}" for other in random.sample(others, random.choice((0, 0, 1, 2)))}
    text = manifest_text(
        name,
        sorted(f"{line}</{line[1:].partition('>')[0]}>" for line in lines),
        random.choice(("ament_cmake", "ament_python", "cmake", "strange")),
    )
    broken = random.random()
    if broken < 0.7:
        return text
    if broken < 0.75:
        return text.replace("<version>0.1.0</version>", "")
    if broken < 0.8:
        return text.replace("<export>", f"<export>{random.choice(('', ' '))}<build_type>cmake</build_type>")
    if broken < 0.85:
        condition = random.choice(("$ROS_VERSION == 2", "$ROS_VERSION == 1", "$ROS_DISTRO >= humble"))
        return text.replace("<build_type>", f'<build_type condition="{condition}">')
    if broken < 0.9:
        return text.replace("<export>", '<exec_depend condition="$A =">alpha</exec_depend><export>').replace(name, "name", 1)
    if broken < 0.95:
        return text.partition("<export>")[0] + "</package>\n"
    return text[: len(text) // 2]


def _cmake(random: Random) -> str:
    name = random.choice(PACKAGES)
    project = random.choice(
        (f"project({name})", f'PROJECT ( "{name}" VERSION 1.0\n LANGUAGES CXX)', "project(${NAME})", f"project({name}# no\n)", "",
         "project(Project)\ncatkin_workspace()", f"# project(other)\nproject({name})",
         f'message("# {name}")\nproject({name} CXX)')
    )  # fmt: skip
    finds = [
        random.choice(
            ("find_package({0} REQUIRED)", "# find_package({0})", 'find_package("{0}")', "find_package({0}Config.cmake)",
             "find_package(\n  {0}\n  COMPONENTS x)", "pkg_check_modules(X REQUIRED {0}>=1 zeta)", "find_package(${{{0}}})",
             "Find_Package( {0} )", "pkg_search_module(Y {0} # note\n)", 'set(x "{0}\n") # "\nfind_package({0})')
        ).format(random.choice(PACKAGES))
        for _ in range(random.choice((0, 1, 1, 2)))
    ]  # fmt: skip
    return "\n".join(["cmake_minimum_required(VERSION 3.8)", project, *finds, ""])


def _setup_cfg(random: Random) -> str:
    name = random.choice((*PACKAGES, ""))
    needs = random.sample(PACKAGES, 2)
    return (
        (f"[metadata]\nname = {name}\n" if name else "[metadata]\nauthor = me\n")
        + f"[options]\ninstall_requires =\n  {needs[0]}>=1.0\n  requests; python_version < '3'\n"
        + random.choice(("", f"setup_requires = {needs[1]}\n", f"[options.extras_require]\ntest =\n  {needs[1]}\n"))
    )


def _colcon_pkg(random: Random) -> str:
    lines = []
    if random.random() < 0.5:
        lines.append(f"name: {random.choice(PACKAGES)}")
    if random.random() < 0.5:
        lines.append(f"type: {random.choice(('cmake', 'ros', 'ros.ament_cmake', 'python', 'other'))}")
    lines += random.sample(META, random.choice((0, 1, 2)))
    # Never a broken one: colcon then leaves out the edges of whichever packages it has not come to yet.
    return "\n".join(lines).format(*random.sample(PACKAGES, 2))


def _meta(random: Random, folders: list[str]) -> str:
    lines = ["names:"]
    for name in random.sample(PACKAGES, 2):
        lines += [f"  {name}:", "    " + random.choice(META).format(*random.sample(PACKAGES, 2))]
    lines.append("paths:")
    for folder in random.sample(folders, min(2, len(folders))):
        lines += [
            f"  {folder}:",
            "    " + random.choice(("name: alpha", "type: cmake", *META)).format(*random.sample(PACKAGES, 2)),
        ]
    return "\n".join(lines) if random.random() < 0.9 else random.choice(("", "- a", "a: ["))
