"""Reports made by hand, with everything that a report can hold, for the tests of reporters."""

from __future__ import annotations

from ros_lint.analysis.finding import Confidence, Finding, Fix, Related, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, Text, read
from ros_lint.engine.merge import merge
from ros_lint.engine.report import OFF, UNSURE, BlindSpot, Crash, HiddenCount, Issue, Report
from ros_lint.workspace.target import NamedDistro, TargetDistro, UnreadFile

DOC = """
## What it finds

A package that is used, but not named in `package.xml`: a header that is included, a `find_package`
in `CMakeLists.txt`, an *import*.

## Why it matters

The build works as long as somebody else happens to build the missing package first.

## How to fix it

Add `<depend>` to `package.xml`. The fix does this.

## Limitations

A name that is in no index is not taken for a package.
"""


def rule(name: str, code: str, severity: Severity, summary: str, *, default: bool = True) -> Rule:
    return Rule(name, code, summary, severity, "0.1", DOC, default=default, fixable=True)


CYCLE = rule("dependency-cycle", "ROS102", Severity.ERROR, "packages do not depend on each other cyclically")
UNDECLARED = rule("undeclared-dependency", "ROS201", Severity.ERROR, "a package that is used must be declared")
TRANSITIVE = rule("transitive-dependency", "ROS203", Severity.WARNING, "what is used is declared itself", default=False)
UNUSED = rule("unused-dependency", "ROS204", Severity.WARNING, "a declared package must be used")
ARGUMENT = rule("launch-unused-argument", "ROS519", Severity.INFO, "an argument that is declared must be used")
RULES = (CYCLE, UNDECLARED, TRANSITIVE, UNUSED, ARGUMENT)

SOURCES = {
    path: source.encode("utf-8", "surrogateescape")
    for path, source in {
        "ws/arm/package.xml": (
            '<?xml version="1.0"?>\r\n<package format="3">\r\n  <name>arm</name>\r\n  <depend\r\n'
            '    condition="$ROS_VERSION == 2"\r\n  >hand</depend>\r\n  <exec_depend>rviz2</exec_depend>\r\n</package>\r\n'
        ),
        "ws/hand/package.xml": "\ufeff<package>\n  <name>hand</name>\n\t<depend>arm</depend>\n</package>\n",
        "ws/talker/CMakeLists.txt": (
            "project(talker)\nfind_package(ament_cmake REQUIRED)\n\nament_target_dependencies(talker rclcpp std_msgs)\n\n\n"
            + "".join(f"# {n}\n" for n in range(7, 100))
            + "install(TARGETS talker\n  DESTINATION lib/${PROJECT_NAME}\n  # 3\n  # 4\n  # 5\n  # 6\n  # 7\n  # 8\n)\n"
        ),
        "ws/talker/src/talker.cpp": (
            '#include <rclcpp/rclcpp.hpp>\nconst char * s = "日本語 e\u0301 \u202etxet\u202c"; /* ✓ */ foo::Bar b;\n'
            "\t\tif (x)\tbar::baz();\n" + "int x; " * 40 + "far::away(); " + "int y; " * 40 + "\nend"
        ),
        "ws/talker/launch/mit leerzeichen [ö] #1%.launch.py": "def generate_launch_description():\n    Node(package='x')\n",
        "ws/talker/resource/talker": "whole",
        "ws/talker/empty.py": "",
        "ws/talker/bytes.py": "# caf\udce9 \x1b[31m\x07\nimport numpy\n",
    }.items()
}


def texts(path: str) -> Text | None:
    return read(path, SOURCES[path]) if path in SOURCES else None


def at(path: str, words: str, nth: int = 1) -> Span:
    """Return the nth place of some words in a file."""
    text = texts(path)
    assert text is not None
    start = -1
    for _ in range(nth):
        start = text.text.index(words, start + 1)
    return text.span(start, start + len(words))


ARM, HAND, CMAKE, CPP = (
    "ws/arm/package.xml",
    "ws/hand/package.xml",
    "ws/talker/CMakeLists.txt",
    "ws/talker/src/talker.cpp",
)
LAUNCH = "ws/talker/launch/mit leerzeichen [ö] #1%.launch.py"
TALL = at(CMAKE, "install(TARGETS talker\n  DESTINATION lib/${PROJECT_NAME}\n  # 3\n  # 4\n  # 5\n  # 6\n  # 7\n  # 8\n)")
DECLARE = Fix("declare std_msgs as <depend>", (Edit(at(HAND, "\n</package>").start(), "\n\t<depend>std_msgs</depend>"),))

FINDINGS = [
    (
        CYCLE,
        "arm",
        Finding(
            "dependency cycle arm -> hand -> arm",
            at(ARM, '<depend\r\n    condition="$ROS_VERSION == 2"\r\n  >hand</depend>'),
            "arm hand",
            (Related("hand needs arm", at(HAND, "<depend>arm</depend>")),),
            package="arm",
            steps=True,
        ),
    ),
    (
        UNUSED,
        "arm",
        Finding(
            "rviz2 is never used",
            at(ARM, "rviz2"),
            "rviz2",
            (Related("named in a file that is gone", Span("ws/arm/gone.cpp", 12, 1, 12, 5)),),
            Fix("remove rviz2", (Edit(at(ARM, "  <exec_depend>rviz2</exec_depend>\r\n"), ""),), safe=False),
        ),
    ),
    (UNDECLARED, "talker", Finding("rclcpp is used, but package.xml does not declare it", at(CMAKE, "rclcpp"), "rclcpp")),
    (
        UNDECLARED,
        "talker",
        Finding(
            "std_msgs is used, but package.xml does not declare it",
            at(CMAKE, "std_msgs"),
            "std_msgs",
            (
                Related("#include <std_msgs[0]> is used here", at(CPP, "<rclcpp/rclcpp.hpp>")),
                Related("dependencies are declared here", at(HAND, "<depend>arm</depend>")),
                Related("in a file that is gone", Span("ws/talker/gone.cpp", 12, 1, 12, 5)),
            ),
            DECLARE,
        ),
    ),
    (
        TRANSITIVE,
        "talker",
        Finding(
            "foo is declared by way of hand only",
            at(CPP, "foo::Bar"),
            "foo",
            (
                Related("and here", at(CPP, "bar::baz")),
                Related("and far away", at(CPP, "far::away()")),
            ),
            confidence=Confidence.MEDIUM,
        ),
    ),
    (TRANSITIVE, "talker", Finding("the end", at(CPP, "end"), "end", severity=Severity.INFO)),
    (
        UNUSED,
        "talker",
        Finding(
            "talker is installed, did you mean listener?",
            TALL,
            "talker",
            tuple(Related(f"place {n}", at(CMAKE, f"# {n}\n").start()) for n in range(10, 24)),
        ),
    ),
    (UNUSED, "talker", Finding("numpy \x1b[31m [red] ] \x07 is a\nnewline", at("ws/talker/bytes.py", "numpy"), "numpy")),
    (ARGUMENT, "talker", Finding("argument 'x' is declared and never used: 100% of it, here", at(LAUNCH, "'x'"), "x")),
    (UNUSED, "talker", Finding("the whole file", at("ws/talker/resource/talker", "whole"), "whole")),
    (UNUSED, "talker", Finding("an empty file", Span("ws/talker/empty.py", 1, 1, 1, 1), "empty")),
    (UNUSED, "", Finding("nothing here", Span("ws/gone", 1, 1, 1, 1), "gone")),
]
ISSUES = tuple(
    sorted(
        (Issue(rule, package, finding) for rule, package, finding in FINDINGS),
        key=lambda issue: (issue.finding.span, issue.rule.code, issue.finding.message),
    )
)
TRACEBACK = "Traceback (most recent call last):\n  File \"rule.py\", line 1, in check\nKeyError: 'x'\n"

EVERYTHING = Report(
    issues=ISSUES,
    rules=RULES,
    packages=3,
    target=TargetDistro("jazzy", "newest LTS"),
    named_distros=(NamedDistro("humble", ".github/workflows/ci.yaml", 12),),
    data_date="2026-11-01",
    version="0.1.0",
    hidden=(
        HiddenCount(UNSURE, 4, (("transitive-dependency", 1), ("undeclared-dependency", 3))),
        HiddenCount("suppressed by comments", 1),
        HiddenCount(OFF, 6, (("dead-group", 1), ("transitive-dependency", 5))),
    ),
    not_checked=(
        UnreadFile("the file", "Permission denied", Span("ws/secret/package.xml", 1, 1, 1, 1)),
        UnreadFile("unknown-dependency", "there is no index for distribution jazzy", None),
    ),
    blind_spots=(BlindSpot("executables", ("bringup", "talker")), BlindSpot("used dependencies", ("talker",))),
    ros1=("old_driver",),
    crashes=(
        Crash("unused-dependency", "talker", TRACEBACK),
        Crash("dependency-cycle", "", TRACEBACK),
        Crash("renamed-package", "talker", TRACEBACK, "acme-rules 1.0"),
    ),
    workspace="ws",
    package_names=("arm", "hand", "talker"),
)
CLEAN = Report((), RULES, 1, TargetDistro("humble", "--distro"), "2026-11-01", "0.1.0", package_names=("arm",))
NOTHING = CLEAN._replace(packages=0, package_names=())
SOUND = EVERYTHING._replace(issues=tuple(issue for issue in ISSUES if issue.finding.span.path != "ws/gone"))
"""Without a finding about a file that is not there."""
SEVERAL = CLEAN._replace(
    issues=merge(
        [
            ("humble", ISSUES[:3]),
            ("jazzy", (ISSUES[0], ISSUES[2]._replace(finding=ISSUES[2].finding._replace(message="another message")))),
        ]
    ),
    target=TargetDistro("humble", "--distro", others=("jazzy",)),
)
"""A report for two distributions."""
REPORTS = {"everything": EVERYTHING, "clean": CLEAN, "nothing": NOTHING, "sound": SOUND, "several": SEVERAL}
