"""What is said of a setup.py: its places, what is wrong in it, and what cannot be followed."""

from __future__ import annotations

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.setup_py.evaluate import evaluate
from ros_lint.facts.visibility import Facet
from tests.setup_scripts import FILES, HEAD, script


@pytest.mark.parametrize(
    ("body", "hidden", "reason"),
    [
        ("setup(name='pkg', data_files=compute())", Facet.SHARE | Facet.EXECUTABLES, "compute() cannot be evaluated"),
        (
            "setup(name='pkg', data_files=[('share/pkg', open('x').readlines())])",
            Facet.SHARE,
            "open('x').readlines() cannot be evaluated",
        ),
        ("setup(name='pkg', data_files=[('lib/pkg', os.environ['X'])])", Facet.EXECUTABLES, "os.environ is not known"),
        ("from x import packages\nsetup(name='pkg', packages=packages)", Facet.PYTHON, "x.packages is not known"),
        ("setup(name='pkg', entry_points={'console_scripts': read()})", Facet.EXECUTABLES, "read() cannot be evaluated"),
        (
            "setup(**read_all())",
            Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON,
            "read_all() cannot be evaluated",
        ),
        ("x = 1", Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON, "it contains no call of setup()"),
        ("x = [1]\nfor i in x: x.append(i)\nsetup()", Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON, "more steps"),
        ("def f(): return f()\nsetup(name='pkg', data_files=f())", Facet.SHARE | Facet.EXECUTABLES, "f() cannot be evaluated"),
        ("while True: pass\nsetup()", Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON, "more steps"),
        ("setup(name='pkg'", Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON, "the source is not valid Python 3"),
        ("print 'pkg'\nsetup()", Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON, "the source is not valid Python 3"),
        (
            "from setuptools.command.install import install\nclass Mine(install): pass\n"
            "setup(name='pkg', cmdclass={'install': Mine})",
            Facet.SHARE | Facet.EXECUTABLES | Facet.PYTHON,
            "the command install is replaced by Mine, which may install anything",
        ),
        ("from skbuild import setup\nsetup(name='pkg')", Facet.SHARE | Facet.LIBRARIES, "setup() of skbuild may install"),
        ("data = []\nfill(data)\nsetup(name='pkg', data_files=data)", Facet.SHARE, "fill(data) may change it"),
        ("setup(name='pkg', data_files=[(os.sep.join(['share', x]), ['package.xml'])])", Facet.SHARE, "the name x"),
        (
            "setup(name='pkg', data_files=[('share/pkg', ['package.xml'] * 10 ** 9)])",
            Facet.SHARE,
            "10 ** 9 cannot be evaluated",
        ),
        ("setup(name='pkg', data_files=[('share/pkg', ['package.xml'] * 1000000000)])", Facet.SHARE, "is too large"),
        ("setup(name='pkg', data_files=[('share/pkg', ['%99999d' % 1])])", Facet.SHARE, "is too large"),
    ],
)
def test_what_is_not_known_is_opaque(body: str, hidden: Facet, reason: str) -> None:
    found = script(body)
    assert any(hidden in opaque.hides and reason in opaque.reason for opaque in found.opaque), found.opaque
    assert not any(item.path.startswith("share") for item in found.products.installs)


@pytest.mark.parametrize(
    "template",
    [
        "{0.at.__func__.__globals__[ast].sys.modules[os].environ[SECRET]}",
        "{text.at.__func__.__globals__[ast].sys.modules[os].environ[SECRET]}",
        "{0:{0.at.__func__.__globals__[ast].sys.modules[os].environ[SECRET]}}",
    ],
)
def test_a_format_does_not_read_the_environment_of_the_machine(monkeypatch: pytest.MonkeyPatch, template: str) -> None:
    """Attributes of a value lead to the modules of the evaluator."""
    monkeypatch.setenv("SECRET", ">12")
    found = script(f"setup(name='pkg', data_files=[('share/pkg', ['x{template}'.format('a', text='a')])])")
    assert any(Facet.SHARE in opaque.hides for opaque in found.opaque), found
    assert not any(item.path.startswith("share") for item in found.products.installs)


@pytest.mark.parametrize(
    ("expression", "reason"),
    [
        ("'{0.upper}'.format('a')", "'{0.upper}'.format() cannot be evaluated"),
        ("'{0[0]}'.format('a')", "'{0[0]}'.format() cannot be evaluated"),
        ("'{:{}}'.format('x', 20000000)", "'{:{}}'.format() cannot be evaluated"),
    ],
)
def test_a_format_that_reads_parts_or_widths_is_unknown(expression: str, reason: str) -> None:
    found = script(f"setup(name='pkg', data_files=[('share/pkg', [{expression}])])")
    assert any(Facet.SHARE in opaque.hides and reason in opaque.reason for opaque in found.opaque), found.opaque


@pytest.mark.parametrize(
    "body",
    [
        "x = 'aa'\nwhile True: x = x + x",
        "x = 'aa'\nwhile True: x += x",
        "x = ['a']\nwhile True: x = x + x",
        "x = ['a']\nwhile True: x += x",
        "x = 'aa'\nwhile True: x = f'{x}{x}'",
        "x = 'aa'\nwhile True: x = '%s%s' % (x, x)",
        "x = 'aa'\nwhile True: x = '{0}{0}'.format(x)",
        "x = 'aa'\nwhile True: x = x.replace('a', x)",
        "x = 'aa'\nwhile True: x = x.join([x, x, x])",
        "x = ['a']\nwhile True: x = [y for y in x for z in 'ab']",
        "x = ('a',)\nwhile True: x = (*x, *x)",
        "x = {}\nwhile True: x = {'a': x}\n",
        "x = [f()]\nfor y in x: x.append(y)",
        "x = [1]\nfor y in x:\n    if f(): x.append(y)\n    else: x.extend(x)",
        "def f(n): return f(n + 1) + f(n + 2)\nx = f(0)",
        "x = " + "(" * 150 + "1" + ")" * 150 + " + 1" * 3000,
    ],
)
def test_what_takes_too_long_ends(body: str) -> None:
    found = script(f"{body}\nsetup(name='pkg', data_files=x)")
    assert found.opaque
    assert not found.products.installs


def test_the_rest_stays_known() -> None:
    found = script(
        """
version = open('VERSION').read()
setup(name='pkg', version=version, packages=['pkg', *more()],
      data_files=[('share/pkg', ['package.xml']), ('share/pkg/x', files()), *more()])
"""
    )
    assert (found.project.name, found.project.version) == ("pkg", "")
    assert [item.path for item in found.products.installs] == ["share/pkg/package.xml"]
    assert found.products.python_packages == ("pkg", "pkg.node")
    assert [opaque.hides for opaque in found.opaque] == [Facet.PYTHON, Facet.SHARE, Facet.SHARE | Facet.EXECUTABLES]


@pytest.mark.parametrize("failing", ["'a' + 1", "['a'] + ('b',)", "1 / 0", "[][0]", "{}['a']", "int('a')", "[].index(1)"])
def test_a_failing_expression_is_unknown_and_the_rest_stays_known(failing: str) -> None:
    found = script(f"x = {failing}\ny = 'a'\ny += None\nsetup(name='pkg', version=x, scripts=['scripts/tool.py'])")
    assert (found.project.name, found.project.version) == ("pkg", "")
    assert [item.path for item in found.products.installs] == ["bin/tool.py"]


def test_an_unknown_condition_makes_conditional() -> None:
    found = script(
        """
data_files = [('share/pkg', ['package.xml'])]
if os.environ.get('FULL'):
    data_files.append(('share/pkg', ['config/x.yaml']))
    scripts = []
else:
    scripts = ['scripts/tool.py']
for name in os.environ['NAMES'].split():
    data_files += [('share/pkg/' + 'more', ['config/y.yml'])]
if not os.path.isdir('pkg') or os.environ.get('STOP'):
    raise SystemExit('never')
sources = ['launch/a.launch.py'] + (['launch/b_launch.xml'] if 'X' in os.environ else [])
data_files.append(('share/pkg/launch', sources))
setup(name='pkg', version='1' if os.environ.get('X') else '1', data_files=data_files, scripts=scripts)
"""
    )
    assert found.project.version == "1"
    assert [(item.path, item.conditional) for item in found.products.installs] == [
        ("share/pkg/package.xml", False),
        ("share/pkg/x.yaml", True),
        ("share/pkg/more/y.yml", True),
        ("share/pkg/launch/a.launch.py", False),
        ("share/pkg/launch/b_launch.xml", True),
        ("bin/tool.py", True),
    ]
    assert not found.opaque


def test_the_version_of_ros_is_known() -> None:
    found = script(
        """
if int(os.environ['ROS_VERSION']) == 1 or os.getenv('ROS_PYTHON_VERSION') == '2':
    setup(name='old')
elif os.getenv('HOME') or 'X' in dict(os.environ):
    setup(name='pkg', scripts=['scripts/tool.py'])
else:
    setup(name='pkg')
"""
    )
    assert found.project.name == "pkg"
    assert [(item.path, item.conditional) for item in found.products.installs] == [("bin/tool.py", True)]


def test_keys_that_are_not_known_may_be_there() -> None:
    found = script(
        """
options = {os.environ['KEY']: 'x', 'a': 'y'}
scripts = ['scripts/tool.py'] if options.get('b', '') == 'x' or 'b' in options else []
setup(name='pkg', version=options.get('a'), scripts=scripts)
"""
    )
    assert found.project.version == "y"
    assert [(item.path, item.conditional) for item in found.products.installs] == [("bin/tool.py", True)]


def test_two_calls_are_both_conditional() -> None:
    found = script("if os.environ.get('X'): setup(name='a', scripts=['scripts/tool.py'])\nelse: setup(name='a')")
    assert found.project.name == "a"
    assert [(item.path, item.conditional) for item in found.products.installs] == [("bin/tool.py", True)]


def test_no_setup_py() -> None:
    cfg = Text("ws/pkg/setup.cfg", "[metadata]\nname = pkg\n[options]\npackages = pkg\n")
    found = evaluate("pkg", "ws/pkg", sorted(FILES), None, cfg, None)
    assert (found.path, found.project.name, found.products.python_packages) == ("ws/pkg/setup.cfg", "pkg", ("pkg", "pkg.node"))
    assert evaluate("pkg", "", [], None, None, None).path == "setup.py"


def test_a_generator_of_parameters_adds_its_module() -> None:
    head = "from generate_parameter_library_py.setup_helper import generate_parameter_module\n"
    found = script(f"{head}generate_parameter_module('params', 'config/x.yaml')\nsetup(name='pkg', packages=['pkg'])")
    assert "pkg.params" in found.products.python_packages
    assert not found.opaque


def test_imports_are_mentions() -> None:
    found = script("from catkin_pkg.python_setup import generate_distutils_setup as g\nsetup(**g(packages=['pkg']))")
    assert [mention.name for mention in found.mentions] == ["setuptools", "glob", "os", "glob", "catkin_pkg.python_setup"]
    assert (found.project.name, found.products.python_packages, found.opaque) == ("pkg", ("pkg", "pkg.node"), ())


@pytest.mark.parametrize(
    ("options", "problems"),
    [
        ("data_files=[('share/pkg', ['nope.txt'])]", [("missing-file", "'nope.txt' does not exist", "'nope.txt'")]),
        (
            "data_files=[('share/pkg', glob('models/*'))]",
            [("directory-in-data-files", "'models/robot' is a folder, but data_files can only copy files, "
                    "so the build fails; list only files",
              "glob('models/*')")],
        ),
        (
            "data_files=[('share/' + package_name, sorted(glob('nope/*.py')))]",
            [("empty-glob", "no file matches 'nope/*.py', so nothing is installed to share/pkg; "
                    "correct or remove the pattern", "'share/' + package_name")],
        ),
        (
            "data_files=[['share/pkg', ['package.xml']]]",
            [("data-files-form", "an entry of data_files must be a tuple of a folder and a list of files; "
                    "write ('folder', ['file'])", "'share/pkg'")],
        ),
        (
            "data_files=[('/etc', ['package.xml'])]",
            [("absolute-destination", "data_files cannot install to '/etc', which is outside the install prefix; "
                    "write a relative folder", "'/etc'")],
        ),
        (
            "packages=['pkg', 'pkg.none']",
            [("missing-file", "folder 'pkg/none' of package 'pkg.none' does not exist", "'pkg.none'")],
        ),
        ("py_modules=['none']", [("missing-file", "'none.py' does not exist", "'none'")]),
        ("scripts=['none']", [("missing-file", "'none' does not exist", "'none'")]),
        (
            "entry_points={'console_scripts': ['talker pkg.node:main']}",
            [("entry-point-form", "'talker pkg.node:main' is not of the form 'name = module:function'; "
                    "write it in this form",
              "'talker pkg.node:main'")],
        ),
        ("data_files=[('share/pkg', ['../outside.txt'])]", []),
    ],
)  # fmt: skip
def test_problems_and_their_places(options: str, problems: list[tuple[str, str, str]]) -> None:
    body = f"setup(name='pkg', {options})\n"
    source = Text("ws/pkg/setup.py", HEAD + body)
    found = script(body)
    assert [(problem.kind, problem.message, source.slice(problem.span)) for problem in found.problems] == problems


def test_places() -> None:
    body = """
version = '1.0'
data = [('share/' + package_name, glob('config/*.yaml'))]
data += [(f, [p]) for f, p in [('a', 'package.xml')]]
setup(name=package_name, version=version, data_files=data, scripts=['scripts/tool.py'],
      entry_points={'console_scripts': [f'x = {package_name}.node:main']})
"""
    source = Text("ws/pkg/setup.py", HEAD + body)
    found = script(body)
    assert found.project.name_span is not None
    assert found.project.version_span is not None
    spans = [found.project.name_span, found.project.version_span, *(item.span for item in found.products.installs)]
    assert [source.slice(span) for span in spans] == [
        "'pkg'",
        "'1.0'",
        "glob('config/*.yaml')",
        "'package.xml'",
        "'scripts/tool.py'",
        "f'x = {package_name}.node:main'",
    ]


def test_executables_keep_their_bit() -> None:
    found = script("setup(name='pkg', data_files=[('lib/pkg', ['scripts/tool.py', 'config/x.yaml'])])")
    assert [(item.path, item.program) for item in found.products.installs] == [
        ("lib/pkg/tool.py", True),
        ("lib/pkg/x.yaml", False),
    ]


def test_an_unknown_folder_of_scripts() -> None:
    found = script("setup(name='pkg', scripts=['scripts/tool.py'])", "[install]\ninstall_scripts = $HOME/bin\n")
    assert not found.products.installs
    assert [(item.hides, str(item.span)) for item in found.opaque] == [(Facet.EXECUTABLES, "ws/pkg/setup.cfg:2:1")]


ODD = """None 5 [] {} () "x" f() [f()] {"a":f()} {"console_scripts":5} {"console_scripts":{"a":1}} lambda:1 (1,2,3) [1,"a",None]
{**f()} os.environ sys.argv {1:2} "a"*3 -1 1/0 [][0] [("a",)] [(1,2)] [[1]] [("a",["b"],3)] [(None,None)] [("a","b")] open("x")
b"x" 3.5 ... {"a","b"} True range(5) zip([1],[2]) dict(a=1) os setup find_packages [].append {}["a"] [*glob("*")]
glob("**",recursive=True) [[["pkg"]]] __import__("x") (lambda:(yield))() "{:99999}".format(1) "a b = c = d" [i/0for(i)in[1]]"""


@pytest.mark.parametrize(
    "option", ["name", "version", "packages", "py_modules", "package_dir", "data_files", "scripts", "entry_points", "cmdclass"]
)
def test_odd_options_are_survived(option: str) -> None:
    for odd in ODD.split():
        found = script(f"setup({option}={odd}, **{{}})")
        assert all(isinstance(item.path, str) for item in found.products.installs)
        script(f"x = {odd}\nfor y in x: x.append(y)\nif x: x, y = x\nx += x\nsetup({option}=x)")
        script(f"setup({option}=[{odd}])")
        script(f"setup(**{odd})")
