import re
from pathlib import Path

import pytest

from ros_lint.analysis.finding import Related
from ros_lint.analysis.wording import first_related
from ros_lint.base.suggestions import ask_if_meant, did_you_mean, shorten_list, similar_names
from ros_lint.base.text import Span
from ros_lint.testing import read_cases

FIXTURES = Path(__file__).parent.parent / "fixtures"


def test_a_shortened_list_ends_with_the_number_of_omitted_names() -> None:
    assert shorten_list(["a"]) == "'a'"
    assert shorten_list(iter("abc")) == "'a', 'b', 'c'"
    assert shorten_list("abcde") == "'a', 'b', 'c' and 2 more"


def test_only_the_first_related_places_are_shown() -> None:
    places = [Related("here, too", Span("a.cpp", line, 1, line, 2)) for line in range(1, 7)]
    assert first_related(iter(places)) == tuple(places[:4])
    assert first_related(places[:1]) == tuple(places[:1])


def test_similar_names_are_suggested() -> None:
    assert similar_names("jazy", ["humble", "jazzy"]) == ["jazzy"]
    assert similar_names("jazy", ["humble", "jazzy"], 1, 0.95) == []
    assert did_you_mean([]) == ask_if_meant([]) == ""
    assert ask_if_meant(["a", "b"]) == "; did you mean 'a'?"
    assert did_you_mean(["a", "b"]) == "; did you mean 'a' or 'b'?"
    assert did_you_mean(["<a>"]) == "; did you mean <a>?"
    assert did_you_mean(["a"], ", ") == ", did you mean 'a'?"


_QUOTED = re.compile(r"'[^']*'|`[^`]*`|<(\w+)[^<>]*>[^<>;]*</\1>|<[^<>]*>|\$\w*\{\w+\}")
_CALL = re.compile(r"[\w.$]*\([^()]*\)|ros2 (?:run|launch) \S+ \S+")
_REMEDY = re.compile(
    r"(?:^|[;:] )(?:add|call|correct|create|define|install|list|move|pass|put|remove|rename|require|start|use|write)\b.*|;.*"
)
_MESSAGE = re.compile(r"^(?:error|warning|info)\[[^\]]+\]: (.+)$", re.MULTILINE)
_NAME = re.compile(r"(?<![\w./:*-])(?<!\bto )(?<!\bin )(?:[\w.-]*\w/[\w./-]*\w|\w+(?:\.[a-z]+)+\b|\w+(?:::\w+)+|\w+_\w+)(?!\w)")
_TERMS = frozenset({
    "CMakeLists.txt", "GZ_VERSION", "__init__.py", "ament_cmake", "ament_python", "ament_xmllint", "colcon.pkg", "data_files",
    "find_package", "package.xml", "ros__parameters", "setup.cfg", "setup.py",
})  # fmt: skip
"""Files with a fixed name, build types, tools, variables and keys, which messages do not quote."""


def _unquoted_names(message: str) -> list[str]:
    """Return the names in a message that are not quoted: paths, file names, dotted names, targets and names with underscores.

    Left out are the remedy, tags, commands, and folders after "to" and "in", where files are installed.
    """
    rest = _QUOTED.sub("", message)
    while _CALL.search(rest):
        rest = _CALL.sub("", rest)
    return [name for name in _NAME.findall(_REMEDY.sub("", rest)) if name not in _TERMS]


@pytest.mark.parametrize(
    ("message", "names"),
    [
        ("robot.talk imports 'auction'", ["robot.talk"]),
        ("'lib/robot/talk.py' imports 'words', but scripts/words.py is not installed to lib/robot", ["scripts/words.py"]),
        ("a::b needs 'a', but there is no find_package() for it; add find_package(a REQUIRED) before this use", ["a::b"]),
        ("there is no package nav_msg; did you mean 'nav_msgs'?", ["nav_msg"]),
        ("<depend>nav_msgs</depend> is declared twice; write robot.a:main", []),
        ("'talker' is installed to bin/, where ros2 run does not find it; install it to lib/robot", []),
    ],
)
def test_unquoted_names_in_messages_are_found(message: str, names: list[str]) -> None:
    assert _unquoted_names(message) == names


def test_messages_quote_names() -> None:
    cases = [case for source in sorted(FIXTURES.glob("*.md")) for case in read_cases(source)]
    outputs = [message for case in cases for message in _MESSAGE.findall(case.output or "")]
    wants = [want.text for case in cases for want in case.wants() if not want.text.count("'") % 2]
    assert len(outputs) > 200
    assert {message: names for message in (*outputs, *wants) if (names := _unquoted_names(message))} == {}
