"""setup.py against setuptools, which really runs it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from configparser import ConfigParser
from pathlib import Path

import pytest

from tests.setup_scripts import FILES, HEAD, script

pytestmark = pytest.mark.slow

# Each is the body of a setup.py after HEAD.
VARIANTS = {
    "literals": """
setup(name='pkg', version='1.2.3', packages=['pkg', 'pkg.sub'],
      data_files=[('share/pkg', ['package.xml']), ('share/ament_index/resource_index/packages', ['resource/pkg'])],
      scripts=['scripts/tool.py'],
      entry_points={'console_scripts': ['a = pkg.node:main', 'b=pkg.sub.more:f'], 'ros2cli.command': ['c = pkg.node:X']})
""",
    "names and texts": """
VERSION = '.'.join(str(part) for part in (0, 1, 2))
share = f'share/{package_name}'
setup(name=package_name, version=VERSION, packages=find_packages(exclude=['test']),
      data_files=[(share, ['package.xml']), ('share/%s/launch' % package_name, glob('launch/*.launch.py')),
                  ('share/{}/config'.format(package_name), glob(os.path.join('config', '*.y*ml'))),
                  (os.path.join('share', package_name, 'models'), ['models/' + 'world.sdf'])],
      entry_points={'console_scripts': [f'talker = {package_name}.node:main', 'x = ' + package_name + '.node:main']})
""",
    "globs": """
setup(name='pkg', data_files=[('a', glob('launch/*launch.[pxy][yma]*')), ('b', globs.glob('config/**', recursive=False)),
      ('c', [f for f in glob('models/**/*', recursive=True) if os.path.isfile(f)]), ('d', sorted(glob('./launch/*.py'))),
      ('e', list(globs.iglob('nothing/*'))), ('f', glob('launch/.h*')), ('g', glob('config/[!y]*'))])
""",
    "walk": """
data_files = [('share/' + package_name, ['package.xml'])]
for root, folders, files in os.walk('models'):
    folders.sort()
    if files:
        data_files.append((os.path.join('share', package_name, root), [os.path.join(root, name) for name in files]))
setup(name=package_name, data_files=data_files)
""",
    "helper function": """
def package_files(data_files, directory_list):
    paths_dict = {}
    for directory in directory_list:
        for (path, directories, filenames) in os.walk(directory):
            for filename in filenames:
                file_path = os.path.join(path, filename)
                install_path = os.path.join('share', package_name, path)
                if install_path in paths_dict.keys():
                    paths_dict[install_path].append(file_path)
                else:
                    paths_dict[install_path] = [file_path]
    for key in paths_dict.keys():
        data_files.append((key, paths_dict[key]))
    return data_files
files = [('share/' + package_name, ['package.xml'])]
setup(name=package_name, data_files=package_files(files, ['models/', 'launch', 'config']))
""",
    "pathlib": """
from pathlib import Path
here = Path(__file__).parent
def tree(folder):
    return [(str(Path('share') / package_name / path.parent), [str(path)])
            for path in sorted(Path(folder).rglob('*')) if path.is_file()]
setup(name=package_name, data_files=[*tree('models'), *tree('launch'),
      ('share/x', [str(p) for p in Path('config').iterdir() if p.suffix == '.yaml']),
      ('share/y', [p.as_posix() for p in Path('.').glob('launch/*.xml')])])
""",
    "listdir and conditions": """
data = []
for name in os.listdir('config'):
    if name.endswith('.yaml') and os.path.exists(os.path.join('config', name)):
        data += [('share/pkg/config', ['config/' + name])]
    elif not name.startswith('y'):
        data.insert(0, ('never', []))
    else:
        data.extend([('share/pkg/other', [f'config/{name}'])])
try:
    import nothing_of_that_name
except ImportError:
    nothing_of_that_name = None
if os.path.isdir('launch') and 'launch' in os.listdir('.'):
    data.append(('share/pkg/launch', [os.path.join('launch', n) for n in os.listdir('launch') if 'launch' in n]))
count = 0
while count < 3:
    count += 1
    if count == 2:
        continue
    data.append((f'share/pkg/{count}', ['package.xml']))
setup(name=package_name, version='1.0' if data else '2.0', data_files=data)
""",
    "dicts and keywords": """
options = dict(name=package_name, version='3.2.1')
options.update({'packages': [package_name, '.'.join([package_name, 'sub'])]})
options['data_files'] = [tuple(['share/pkg', ['package.xml']])]
extra = {**options, 'py_modules': ['a_module']}
scripts = {'talker': 'pkg.node', 'listener': 'pkg.sub.more'}
setup(**extra, entry_points={'console_scripts': ['%s = %s:main' % (k, v) for k, v in scripts.items()]},
      package_dir={'': '.'})
""",
    "ini entry points": """
setup(name='pkg', packages=['pkg'], entry_points='''
[console_scripts]
one = pkg.node:main
# a comment
two = pkg.node:main [extra]

[other.group]
three = pkg.node
''')
""",
    "lambdas, maps and slices": """
names = ['config/x.yaml', 'config/y.yml', 'package.xml'][:2]
pairs = list(map(lambda p: ('share/pkg/' + os.path.dirname(p), [p]), names)) + [('z', list(reversed(names))[0:1]),
         ('s', sorted(names, key=lambda n: n[-1], reverse=True)[:1])]
pairs += [(a, [b]) for a, b in zip(['m', 'n'], names)]
pairs.extend(('e%d' % i, [n]) for i, n in enumerate(filter(lambda n: n.endswith('l'), names), start=1))
first, *rest = names
setup(name='pkg'.strip().lower().replace('_', '-'), data_files=pairs + [('first', [first]), ('rest', rest)])
""",
    "main guard and src": """
def main():
    global version
    version = '9.9'
    setup(name=package_name, version=version, package_dir={'': 'pkg'}, packages=find_packages('pkg'),
          py_modules=['node'])
if __name__ == '__main__':
    main()
""",
    "absolute through __file__": """
here = os.path.abspath(os.path.dirname(__file__))
rel = [os.path.relpath(p, here) for p in glob(os.path.join(here, 'config', '*.yaml'))]
setup(name='pkg', data_files=[('share/pkg', rel)], packages=find_packages(where='.', include=['pkg', 'pkg.*']))
""",
    "generate distutils setup": """
from itertools import chain, product
setup(name='pkg', data_files=[('share/' + a + b, ['package.xml']) for a, b in product('xy', ['1', '2'])]
      + list(chain([('u', [])], *[[('v', ['package.xml'])]], chain.from_iterable([[('w', [])], []]))))
""",
}

RUNNER = """
import json, os, sys, setuptools, distutils.core, warnings
warnings.simplefilter("ignore")
given = {}
def setup(**options):
    given.update(options)
setuptools.setup = distutils.core.setup = setup
out = {}
for name, text in json.load(sys.stdin).items():
    given.clear()
    open("setup.py", "w").write(text)
    exec(compile(text, "setup.py", "exec"), {"__name__": "__main__", "__file__": os.path.abspath("setup.py")})
    out[name] = dict(given)
json.dump(out, sys.stdout)
"""


ENVIRONMENT = {"PATH": os.environ["PATH"], "PYTHONDONTWRITEBYTECODE": "1"}


def write_package(base: Path) -> None:
    for path, content in FILES.items():
        (base / path).parent.mkdir(parents=True, exist_ok=True)
        (base / path).write_text(content)
    (base / "scripts/tool.py").chmod(0o755)


def run_python(program: str, folder: Path, given: object) -> dict[str, dict[str, object]]:
    """Run a program that turns JSON into JSON."""
    command = [sys.executable, "-W", "ignore", "-c", program]
    text = json.dumps(given)
    done = subprocess.run(command, input=text, cwd=folder, capture_output=True, text=True, check=True, env=ENVIRONMENT)
    return json.loads(done.stdout)  # type: ignore[no-any-return]


@pytest.fixture(scope="module")
def truth(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, object]]:
    """Return what setup() was really called with, by variant."""
    base = tmp_path_factory.mktemp("setup") / "pkg"
    write_package(base)
    return run_python(RUNNER, base, {name: HEAD + body for name, body in VARIANTS.items()})


def installed(data_files: list[list[object]]) -> list[tuple[str, str]]:
    """Return what distutils copies: destination and source."""
    return sorted(
        (os.path.normpath(os.path.join(str(folder), os.path.basename(source))), os.path.normpath(source))
        for folder, sources in data_files
        for source in sources  # type: ignore[attr-defined]
    )


def entry_points(given: Mapping[str, object] | str) -> set[tuple[str, str, str]]:
    if isinstance(given, str):
        parser = ConfigParser(delimiters=("=",))
        parser.read_string(given)
        return {(group, name, value) for group in parser.sections() for name, value in parser[group].items()}
    pairs = ((group, line.partition("=")) for group, lines in given.items() for line in lines)  # type: ignore[attr-defined]
    return {(group, name.strip(), value.strip()) for group, (name, _, value) in pairs}


@pytest.mark.parametrize("variant", VARIANTS)
def test_same_as_setuptools(variant: str, truth: dict[str, dict[str, object]]) -> None:
    given, found = truth[variant], script(VARIANTS[variant])
    assert not found.opaque
    assert (found.project.name, found.project.version) == (given["name"], given.get("version", ""))
    provides = sorted((item.path, item.source) for item in found.products.installs if not item.path.startswith("bin/"))
    assert provides == installed(given.get("data_files", []))  # type: ignore[arg-type]
    assert not any(item.conditional for item in found.products.installs)
    assert {tuple(item[:3]) for item in found.products.entry_points} == entry_points(given.get("entry_points", {}))  # type: ignore[arg-type]
    assert {item.source for item in found.products.installs if item.path == "bin/tool.py"} == set(given.get("scripts", []))  # type: ignore[call-overload]
    packages = {*given.get("packages", []), *given.get("py_modules", [])}  # type: ignore[misc, call-overload]
    if packages:
        assert packages <= set(found.products.python_packages)
        assert {name.rpartition(".")[0] for name in set(found.products.python_packages) - packages} <= packages


BUILT = """
import json, os, sys, setuptools
out = []
for packages in json.load(sys.stdin)["packages"]:
    command = setuptools.Distribution({"packages": packages, "script_name": "setup.py"}).get_command_obj("build_py")
    command.ensure_finalized()
    paths = command.get_outputs(include_bytecode=0)
    out.append([os.path.normpath(os.path.relpath(path, command.build_lib)) for path in paths])
json.dump(out, sys.stdout)
"""


def test_same_modules_as_build_py(tmp_path: Path) -> None:
    """A package may be named by its path, which setuptools only warns of."""
    write_package(tmp_path / "pkg")
    lists = [["pkg"], ["pkg", "pkg.sub"], ["pkg", "pkg/sub"], ["pkg", "pkg/sub/"], ["pkg/sub"]]
    given: object = run_python(BUILT, tmp_path / "pkg", {"packages": lists})
    for packages, paths in zip(lists, given, strict=True):  # type: ignore[call-overload]
        modules = {path.removesuffix(".py").replace("/", ".").removesuffix(".__init__") for path in paths}
        assert set(script(f"setup(name='pkg', packages={packages})").products.python_packages) == modules, packages


# What setup.cfg and pyproject.toml add to setup(name='pkg').
CONFIGURATIONS: dict[str, tuple[str, str, str]] = {
    "setup.cfg": (
        "setup()",
        """
[metadata]
name = pkg
version = 4.5.6
[options]
packages = find:
scripts =
    scripts/tool.py
[options.packages.find]
exclude =
    test*
[options.data_files]
share/pkg = package.xml
share/pkg/launch =
    launch/a.launch.py
    launch/b_launch.xml
[options.entry_points]
console_scripts =
    talker = pkg.node:main
    listener=pkg.sub.more:f
other.group =
    x = pkg.node
""",
        "",
    ),
    "setup() goes before setup.cfg": (
        "setup(name='pkg', version='1.0', packages=['pkg'])",
        "[metadata]\nname = other\nversion = 2.0\n[options]\npackages = pkg, pkg.sub\npy_modules = pkg.node\n",
        "",
    ),
    "folders": (
        "setup(name='pkg')",
        "[options]\npackage_dir =\n    = pkg\npackages = find:\n[options.packages.find]\nwhere = pkg\n",
        "",
    ),
    "pyproject.toml": (
        "setup()",
        "",
        """
[build-system]
requires = ["setuptools"]
[project]
name = "pkg"
version = "7.8.9"
[project.scripts]
talker = "pkg.node:main"
[project.entry-points."other.group"]
x = "pkg.node"
[tool.setuptools]
packages = ["pkg", "pkg.sub"]
[tool.setuptools.data-files]
"share/pkg" = ["package.xml", "config/*.yaml"]
""",
    ),
    "pyproject.toml that finds": (
        "setup()",
        "",
        "[project]\nname = 'pkg'\nversion = '1'\n[tool.setuptools.packages.find]\ninclude = ['pkg*']\n",
    ),
}


CONFIGURED = """
import json, os, sys, setuptools, warnings
warnings.simplefilter("ignore")
def configured(**options):
    global found
    found = setuptools.Distribution(options)
    found.parse_config_files()
setuptools.setup = configured
out = {}
for name, (script, cfg, pyproject) in json.load(sys.stdin).items():
    for path, text in (("setup.cfg", cfg), ("pyproject.toml", pyproject)):
        open(path, "w").write(text) if text else os.path.exists(path) and os.remove(path)
    exec("from setuptools import setup\\n" + script)
    out[name] = {
        "name": found.metadata.name, "version": found.metadata.version or "", "packages": found.packages or [],
        "py_modules": found.py_modules or [], "scripts": found.scripts or [], "data_files": found.data_files or [],
        "entry_points": {group: list(lines) for group, lines in (found.entry_points or {}).items()},
    }
json.dump(out, sys.stdout)
"""


@pytest.fixture(scope="module")
def configured(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, object]]:
    """Return what setuptools makes of configuration files."""
    base = tmp_path_factory.mktemp("configured") / "pkg"
    write_package(base)
    return run_python(CONFIGURED, base, CONFIGURATIONS)


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_same_configuration_as_setuptools(name: str, configured: dict[str, dict[str, object]]) -> None:
    setup_py, cfg, pyproject = CONFIGURATIONS[name]
    given = configured[name]
    found = script(setup_py, cfg or None, pyproject or None, head="from setuptools import setup\n")
    assert not found.opaque
    assert (found.project.name, found.project.version) == (given["name"], given["version"])
    programs = [item for item in found.products.installs if item.path.startswith("bin/")]
    data = sorted((item.path, item.source) for item in found.products.installs if item not in programs)
    assert data == installed(given["data_files"])  # type: ignore[arg-type]
    assert {tuple(item[:3]) for item in found.products.entry_points} == entry_points(given["entry_points"])  # type: ignore[arg-type]
    assert {item.source for item in programs if item.source} == set(given["scripts"])  # type: ignore[call-overload]
    packages = {*given["packages"], *given["py_modules"]}  # type: ignore[misc]
    if packages:
        assert packages <= set(found.products.python_packages)
        assert {name.rpartition(".")[0] for name in set(found.products.python_packages) - packages} <= packages


SCRIPT_FOLDER = "[develop]\nscript_dir=$base/lib/pkg\n[install]\ninstall_scripts=$base/lib/pkg\n"


@pytest.mark.parametrize("cfg", [None, SCRIPT_FOLDER, SCRIPT_FOLDER.replace("_", "-")])
def test_same_files_as_a_real_installation(tmp_path: Path, cfg: str | None) -> None:
    base, prefix = tmp_path / "pkg", tmp_path / "prefix"
    write_package(base)
    body = """
setup(name='pkg', version='1.0', packages=find_packages(exclude=['test']), scripts=['scripts/tool.py'],
      data_files=[('share/pkg', ['package.xml']), ('share/pkg/launch', glob('launch/*.*')), ('share/pkg/empty', []),
                  ('share/pkg/flat', [f for f in glob('models/**', recursive=True) if os.path.isfile(f)]),
                  ('lib/pkg', ['scripts/tool.py', 'config/x.yaml'])],
      entry_points={'console_scripts': ['talker = pkg.node:main', 'listener = pkg.node:main']})
"""
    (base / "setup.py").write_text(HEAD + body)
    if cfg:
        (base / "setup.cfg").write_text(cfg)
    command = ["setup.py", "-q", "install", f"--prefix={prefix}", "--single-version-externally-managed", "--record=r"]
    if cfg:  # as colcon does
        command.append(f"--install-scripts={prefix}/lib/pkg")
    subprocess.run([sys.executable, "-W", "ignore", *command], cwd=base, check=True, capture_output=True, env=ENVIRONMENT)
    real = {
        str(path.relative_to(prefix)): os.access(path, os.X_OK)
        for path in prefix.rglob("*")
        if path.is_file() and "site-packages" not in path.parts
    }
    found = script(body, cfg)
    assert not found.opaque
    assert {item.path: item.program for item in found.products.installs} == real
    modules = {path.relative_to(prefix) for path in prefix.rglob("*.py") if "site-packages" in path.parts}
    dotted = {str(path).partition("site-packages/")[2][:-3].replace("/", ".").removesuffix(".__init__") for path in modules}
    assert set(found.products.python_packages) == dotted
    assert {problem.kind for problem in found.problems} == ({"dashed-key"} if cfg and "-" in cfg else set())
