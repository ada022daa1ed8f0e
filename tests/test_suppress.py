"""Comments that suppress findings: the lines and rules to which they apply, and the edits that remove them."""

from __future__ import annotations

import time
from xml.parsers import expat

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from ros_lint.analysis.finding import Finding, Fix, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.text import Span, Text
from ros_lint.collectors.comments import comments
from ros_lint.collectors.suppressions import collect
from ros_lint.engine import edits
from ros_lint.engine.report import Issue
from ros_lint.engine.suppressions import apply_suppressions
from ros_lint.facts.suppressions import Suppression

RULES = tuple(
    Rule(name, code, "it must be so", Severity.WARNING, "0.1", "")
    for name, code in (("undeclared-dependency", "ROS201"), ("unused-dependency", "ROS204"), ("missing-file", "ROS301"))
)
NAMES = frozenset(rule.name for rule in RULES)


def issue(rule: str, path: str, line: int, end_line: int = 0, end_column: int = 5) -> Issue:
    span = Span(path, line, 3, end_line or line, end_column)
    return Issue(next(r for r in RULES if r.name == rule), "talker", Finding("it is wrong", span, "thing"))


def single(path: str, source: str) -> Suppression:
    (suppressions,) = collect(Text(path, source))
    return suppressions


def covered(suppressions: Suppression, lines: int) -> list[int]:
    return [n for n in range(1, lines + 1) if suppressions.covers(issue("missing-file", suppressions.span.path, n).finding.span)]


# --- which comments count ------------------------------------------------------------------------------------------

TRUE_COMMENTS = {
    "p/package.xml": "<package>\n  <depend>foo</depend> <!-- ros-lint: ignore[ROS204] for the demo -->\n</package>\n",
    "p/launch/a.launch": "<launch>\n  <node/> <!--ros-lint:ignore[ROS204] for the demo-->\n</launch>\n",
    "p/urdf/robot.urdf.xacro": "<robot>\n<x/> <!-- ros-lint: ignore[ROS204] for the demo -->\n</robot>",
    "p/CMakeLists.txt": 'set(A "#")\nfind_package(foo) # ros-lint: ignore[ROS204] for the demo\n',
    "p/cmake/extras.cmake.in": "@PACKAGE_INIT@\nfoo(#[[ ros-lint: ignore[ROS204] for the demo ]] bar)\n",
    "p/setup.py": "#!/usr/bin/env python3\nimport foo  # ros-lint: ignore[ROS204] for the demo\n",
    "p/scripts/node": "#!/usr/bin/env python3\nimport foo  # ros-lint: ignore[ROS204] for the demo\n",
    "p/setup.cfg": "[develop]\n  # ros-lint: ignore[ROS204] for the demo\n",
    "p/config/a.yaml": "a: 1\nb: 2 # ros-lint: ignore[ROS204] for the demo\n",
    "p/src/a.cpp": "int a;\n#include <foo/foo.hpp>  // ros-lint: ignore[ROS204] for the demo\n",
    "p/include/p/a.hpp": "int a;\nint /* ros-lint: ignore[ROS204] for the demo */ b;\n",
    "p/msg/A.msg": "int32 a\nfoo/Bar b # ros-lint: ignore[ROS204] for the demo\n",
    "p/idl/A.idl": "module p {\n  struct A; // ros-lint: ignore[ROS204] for the demo\n};\n",
    "p/src/Main.java": "class A {\n  int a; // ros-lint: ignore[ROS204] for the demo\n}\n",
    "p/src/main.rs": "use foo::<'a>;\nuse bar; // ros-lint: ignore[ROS204] for the demo\n",
    "p/pyproject.toml": "[project]\nname = 'p' # ros-lint: ignore[ROS204] for the demo\n",
}


@pytest.mark.parametrize(("path", "source"), TRUE_COMMENTS.items())
def test_suppressions_work_in_every_language(path: str, source: str) -> None:
    suppressions = single(path, source)
    assert [name.text for name in suppressions.names] == ["ROS204"]
    assert suppressions.reason == "for the demo"
    assert suppressions.problem == ""
    assert suppressions.lines is not None
    assert 2 in range(suppressions.lines[0], suppressions.lines[1] + 1)
    assert Text(path, source).slice(suppressions.span).replace(" ", "") == "ros-lint:ignore[ROS204]"


MARK = "ros-lint: ignore[ROS204]"
NO_COMMENTS = [
    ("p/package.xml", f"<package><description><![CDATA[<!-- {MARK} -->]]></description></package>"),
    ("p/package.xml", f"<package><description>{MARK}</description></package>"),
    ("p/package.xml", f"<package><?note <!-- {MARK} --> ?></package>"),
    ("p/CMakeLists.txt", f'message("# {MARK}")\n'),
    ("p/CMakeLists.txt", f'message("a \\" # {MARK}")\n'),
    ("p/CMakeLists.txt", f"message([==[\n# {MARK}\n]] ]==])\n"),
    ("p/setup.py", f'"""\n# {MARK}\n"""\n'),
    ("p/setup.py", f"a = '# {MARK}'\n"),
    ("p/setup.py", f"a = f'''{{b}} # {MARK}'''\n"),
    ("p/setup.cfg", f"[metadata]\nname = p # {MARK}\n"),
    ("p/a.yaml", f"a: |\n  text\n  # {MARK}\nb: 1\n"),
    ("p/a.yaml", f'a: "b\n  # {MARK}"\n'),
    ("p/a.yaml", f"a: b# {MARK}\n"),
    ("p/a.cpp", f'auto a = "// {MARK}";\n'),
    ("p/a.cpp", f'auto a = "\\"// {MARK}";\n'),
    ("p/a.cpp", f'auto a = R"x(\n)" // {MARK}\n)x";\n'),
    ("p/a.msg", f"string A='# {MARK}'\n"),
    ("p/README.md", f"<!-- {MARK} -->\n# {MARK}\n"),
    ("p/a.json", f"// {MARK}\n"),
]


@pytest.mark.parametrize(("path", "source"), NO_COMMENTS)
def test_a_string_is_not_a_comment(path: str, source: str) -> None:
    assert collect(Text(path, source)) == ()


def test_unpaired_quotes_do_not_hide_comments() -> None:
    assert single("a.cpp", f"int a = 1'000'000; char b = '\"'; // {MARK}\n")
    assert single("a.cpp", f"#error don't\nint a; // {MARK}\n")
    assert single("a.yaml", f"a: don't\nb: it's # {MARK}\n")
    assert single("CMakeLists.txt", f'set(a \\") # {MARK}\n')


def test_comments_before_a_syntax_error_count() -> None:
    assert single("setup.py", f"import foo  # {MARK}\ndef (((\n")
    assert single("package.xml", f"<package><!-- {MARK} --><a")
    assert single("a.yaml", f"a: @x@ # {MARK}\nb: [\n")


# --- against other parsers ------------------------------------------------------------------------------------------

XML_PARTS = st.sampled_from(
    [
        *("<!--a-->", "<!-- - > <b> -->", "<![CDATA[<!--no-->]]>", "<?pi <!--no--> ?>", "text", "<b c='>' d=\"--\"/>"),
        *("\r\n", "ä😀", "--"),
    ]
)


@given(st.lists(XML_PARTS))
def test_xml_comments_equal_those_of_expat(parts: list[str]) -> None:
    text = f"<a>{''.join(parts)}</a>"
    expected: list[str] = []
    parser = expat.ParserCreate()
    parser.CommentHandler = expected.append
    parser.Parse(text, True)
    assert [text[start + 4 : end - 3] for start, end in comments(Text("a.xml", text))] == expected


YAML_PARTS = st.sampled_from(
    [
        *("a: 1", " # c1", "# c2", "\n", "b: 'x # c'", 'c: "x # c"', "d: |\n  # c\n", "- # c3", "e# c", "'", '"'),
        *(": ", "{", "}", "\n  ", "g: >-\n\n   # c\n  h", "\r\n", "ä😀"),
    ]
)


@given(st.lists(YAML_PARTS))
def test_yaml_comments_are_outside_the_tokens_of_the_parser(parts: list[str]) -> None:
    text = "".join(parts)
    try:
        in_values = [event.value for event in yaml.parse(text) if isinstance(event, yaml.ScalarEvent)]
    except yaml.YAMLError:
        return
    ranges = comments(Text("a.yaml", text))
    in_comments = [text[start:end] for start, end in ranges]
    assert text.count("# c") == sum(value.count("# c") for value in [*in_values, *in_comments])
    bare = text
    for start, end in reversed(ranges):
        bare = bare[:start] + "#" + bare[end:]
    assert [event.value for event in yaml.parse(bare) if isinstance(event, yaml.ScalarEvent)] == in_values


# --- which lines ---------------------------------------------------------------------------------------------------


def test_a_suppression_at_the_end_of_a_line_applies_to_the_line() -> None:
    assert covered(single("a.py", f"a\nb  # {MARK}\nc\n"), 3) == [2]


def test_a_suppression_alone_on_its_line_applies_to_the_next_line() -> None:
    assert covered(single("a.py", f"a\n  # {MARK}\nc\nd\n"), 4) == [2, 3]


def test_a_suppression_applies_past_following_comments() -> None:
    assert covered(single("CMakeLists.txt", f"a()\n# {MARK}\n# more\n#[[ and\nmore ]]\nb()\nc()\n"), 7)[-1] == 6


def test_a_suppression_in_a_comment_of_several_lines_applies_to_the_next_line() -> None:
    assert covered(single("a.xml", f"<a>\n<!--\n  {MARK}\n  because\n-->\n<b/>\n<c/>\n</a>"), 8)[-1] == 6


def test_a_comment_followed_by_code_applies_to_its_own_line() -> None:
    assert covered(single("a.cpp", f"/* {MARK} */ int a;\nint b;\n"), 2) == [1]


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_suppressions_work_with_every_line_end(newline: str) -> None:
    for path, comment in (("a.py", f"# {MARK} so"), ("a.xml", f"<!-- {MARK} so -->"), ("a.cpp", f"// {MARK} so")):
        suppressions = single(path, newline.join(["", comment, "x = 1", ""]))
        assert (suppressions.lines, suppressions.reason) == ((2, 3), "so")
        suppressions = single(path, newline.join(["x = 1", f"  {comment}", "x = 1", ""]))
        assert suppressions.lines == (2, 3)


def test_a_suppression_may_be_on_any_line_of_a_finding() -> None:
    suppressions = single("a.xml", f"<a>\n<b\n  c=''\n/> <!-- {MARK} -->\n<d/>\n</a>")
    assert suppressions.covers(issue("missing-file", "a.xml", 2, 4).finding.span)
    assert not suppressions.covers(issue("missing-file", "a.xml", 2, 3).finding.span)
    assert not suppressions.covers(issue("missing-file", "a.xml", 2, 4, end_column=1).finding.span), "it ends with line 3"
    assert not suppressions.covers(issue("missing-file", "other.xml", 2, 4).finding.span)


# --- the whole file ------------------------------------------------------------------------------------------------

FILE_MARK = "ros-lint: ignore-file[ROS204] vendored"


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("a.py", f"#!/usr/bin/env python3\n# Copyright\n\n# {FILE_MARK}\nimport foo\n"),
        ("a.xml", f"\ufeff<?xml version='1.0'?>\n<?xml-model href='x'?>\n<!-- {FILE_MARK} -->\n<a/>"),
        ("a.xml", f"<?xml version='1.0'?><!DOCTYPE a [ <!ELEMENT a (b)> ]>\n<!-- {FILE_MARK} -->\n<a/>"),
        ("CMakeLists.txt", f"# {FILE_MARK}\nproject(a)\n"),
        ("a.cpp", f"/* Copyright\n */\n// {FILE_MARK}\nint a;\n"),
        ("a.yaml", f"# {FILE_MARK}\na: 1\n"),
    ],
)
def test_ignore_file_applies_to_the_whole_file(path: str, source: str) -> None:
    suppressions = single(path, source)
    assert suppressions.problem == ""
    assert suppressions.lines is None
    assert suppressions.reason == "vendored"
    assert suppressions.covers(issue("missing-file", path, 1000).finding.span)


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("a.py", f'"""Docs."""\n# {FILE_MARK}\n'),
        ("a.xml", f"<a><!-- {FILE_MARK} --></a>"),
        ("CMakeLists.txt", f"project(a)\n# {FILE_MARK}\n"),
    ],
)
def test_ignore_file_after_code_is_a_problem(path: str, source: str) -> None:
    suppressions = single(path, source)
    assert "in the first comments" in suppressions.problem
    assert not suppressions.covers(issue("missing-file", path, 2).finding.span)


# --- what is wrong with it -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("comment", "problem"),
    [
        ("ros-lint: ignore", "names no rule"),
        ("ros-lint: ignore because", "names no rule"),
        ("ros-lint: ignore[]", "names no rule"),
        ("ros-lint: ignore[ , ] because", "names no rule"),
        ("ros-lint: ignore-file", "names no rule"),
        ("ros-lint: ignore[ROS204", "not closed"),
        ("ros-lint: disable=ROS204", "'ros-lint: disable' has no effect"),
        ("ros-lint: ingore[ROS204] so", "'ros-lint: ingore[ROS204]' has no effect"),
        ("type: ignore # ros-lint: ignore", "names no rule"),
    ],
)
def test_invalid_suppressions_are_problems(comment: str, problem: str) -> None:
    suppressions = single("a.py", f"import foo  # {comment}\n")
    assert problem in suppressions.problem
    assert apply_suppressions([issue("missing-file", "a.py", 1)], [suppressions], RULES, NAMES).use.malformed == (suppressions,)
    assert len(apply_suppressions([issue("unused-dependency", "a.py", 1)], [suppressions], RULES, NAMES).kept) == 1


@pytest.mark.parametrize("comment", ["run ros-lint: it helps", "ros-lint: 5 lines", "as ros-lint: rules", "ros-lint:"])
def test_sentences_about_ros_lint_are_not_suppressions(comment: str) -> None:
    assert collect(Text("a.py", f"# {comment}\n")) == ()


@pytest.mark.parametrize(
    ("path", "comment"),
    [
        ("a.xml", "<!-- {mark} why -->"),
        ("a.cpp", "/* {mark} why **/"),
        ("a.cmake", "#[[ {mark} why ]]"),
        ("a.cmake", "#[=[ {mark} why ]=]"),
        ("a.cpp", "// {mark} why  // [a]"),
    ],
)
def test_the_reason_ends_before_the_end_of_its_comment(path: str, comment: str) -> None:
    assert single(path, comment.format(mark="ros-lint: ignore[x]")).reason == "why"
    assert single(path, comment.format(mark="ros-lint: ignore[x] -")).reason == "why"


@pytest.mark.parametrize("reason", ["a]", "a]=", "a]==", "a >", "a #b"])
def test_the_reason_may_end_like_a_comment_of_another_kind(reason: str) -> None:
    assert single("a.cpp", f"// ros-lint: ignore[x] {reason}").reason == reason


def test_comments_and_strings_that_are_not_closed_do_not_hide_what_follows() -> None:
    for path, text in (("a.xml", "<? <![CDATA["), ("a.cpp", 'int a = R"b('), ("a.cmake", "a[=[b"), ("a.cmake", "#[[")):
        sign = "<!-- ros-lint: ignore[x] -->" if path == "a.xml" else "# ros-lint: ignore[x]"
        assert single(path, f"{text}\n{sign.replace('#', '//') if path == 'a.cpp' else sign}\n").reason == ""


def test_several_names_and_suppressions_in_a_comment() -> None:
    source = "# ros-lint: ignore[ROS201, unused-dependency] one # ros-lint: ignore[x] -- two\n"
    first, second = collect(Text("a.py", source))
    assert [name.text for name in first.names] == ["ROS201", "unused-dependency"]
    assert (first.reason, second.reason) == ("one", "two")
    assert str(first.names[1].span) == "a.py:1:28"


# --- what becomes of the issues ------------------------------------------------------------------------------------


def test_suppressed_findings_are_removed() -> None:
    suppressions = collect(Text("a.py", "x  # ros-lint: ignore[ROS201, Missing-File, nosuch, unused-dependancy, ROS999]\n"))
    wanted, other_issue, elsewhere = (
        issue("undeclared-dependency", "a.py", 1),
        issue("unused-dependency", "a.py", 1),
        issue("undeclared-dependency", "a.py", 2),
    )
    outcome = apply_suppressions([wanted, other_issue, elsewhere], suppressions, RULES, NAMES)
    assert outcome.kept == (other_issue, elsewhere)
    assert outcome.suppressed == ((wanted, suppressions[0]),)
    assert [[name.text for name in unused.names] for unused in outcome.use.unused] == [["Missing-File"]]
    assert [(unknown.name.text, unknown.suggestion) for unknown in outcome.use.unknown] == [
        ("nosuch", ""),
        ("unused-dependancy", "unused-dependency"),
        ("ROS999", ""),
    ]


@pytest.mark.parametrize("name", ["launch-argument", "ROS507"])
def test_the_name_of_a_divided_rule_names_the_new_rules(name: str) -> None:
    (unknown,) = apply_suppressions([], collect(Text("a.py", f"x  # ros-lint: ignore[{name}]\n")), RULES, NAMES).use.unknown
    assert unknown.suggestion == ""
    assert unknown.fate.startswith("was divided into 'launch-missing-argument', ")
    assert unknown.fate.endswith(" and 'launch-unused-argument'; name the rules that you mean")


def test_a_suppression_of_a_rule_that_did_not_run_is_not_unused() -> None:
    suppressions = collect(Text("a.py", "x  # ros-lint: ignore[ROS201]\n"))
    assert apply_suppressions([], suppressions, RULES, NAMES - {"undeclared-dependency"}).use.unused == ()


def test_two_suppressions_for_one_finding_are_both_used() -> None:
    suppressions = collect(Text("a.py", "# ros-lint: ignore-file[ROS201]\nx\ny  # ros-lint: ignore[ROS201]\n"))
    outcome = apply_suppressions([issue("undeclared-dependency", "a.py", 3)], suppressions, RULES, NAMES)
    assert (outcome.use.unused, outcome.kept) == ((), ())


def test_findings_about_suppressions_can_be_suppressed() -> None:
    judge = RULES[0]._replace(name="unused-suppression", code="ROS901", suppressions=lambda outcome: ())
    known = (*RULES, judge)
    names = NAMES | {judge.name}
    for mark in ("x  # {}", "# {}\nx"):
        suppressions = collect(Text("a.py", mark.format("ros-lint: ignore[ROS201, ROS901] so\n")))
        outcome = apply_suppressions([], suppressions, known, names)
        assert [[name.text for name in unused.names] for unused in outcome.use.unused] == [["ROS201"]]
        about = [Issue(judge, "p", Finding("", unused.names[0].span, "")) for unused in outcome.use.unused]
        assert apply_suppressions(about, suppressions, known, names).kept == ()


LINES = st.sampled_from(
    ["x\n", f"x  # {MARK}\n", f"# {MARK}\n", "# so\n", "x  # ros-lint: ignore[ROS301]\n", "# ros-lint: ignore-file[ROS204]\n"]
)


@given(st.lists(LINES, max_size=12))
def test_remaining_findings_are_not_covered_by_a_suppression(lines: list[str]) -> None:
    suppressions = collect(Text("a.py", "".join(lines)))
    ends = [(first, last) for first in range(1, len(lines) + 2) for last in (first, first + 2)]
    issues = [issue("unused-dependency", "a.py", first, last) for first, last in ends]
    covering = [issue for issue in suppressions if any(name.text == "ROS204" for name in issue.names)]
    remaining = tuple([issue for issue in issues if not any(single.covers(issue.finding.span) for single in covering)])
    outcome = apply_suppressions(issues, suppressions, RULES, NAMES)
    assert outcome.kept == remaining
    unused = {issue.suppression for issue in outcome.use.unused if issue.names[0].text == "ROS204"}
    idle_by_place = {issue for issue in covering if not any(issue.covers(covered_lines.finding.span) for covered_lines in issues)}
    assert unused == {issue for issue in idle_by_place if not issue.problem}


@pytest.mark.parametrize("lines", ["x  # {mark}\n" * 4000, "# {mark}\n" * 4000, "# {mark}\n" + "# so\n" * 20000])
def test_thousands_of_comments_take_linear_time(lines: str) -> None:
    started = time.process_time()
    suppressions = collect(Text("a.py", lines.format(mark=MARK)))
    apply_suppressions([issue("missing-file", "a.py", line) for line in range(4000)], suppressions, RULES, NAMES)
    assert time.process_time() - started < 5


# --- fixes ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "text_before", "text_after"),
    [
        ("a.py", f"import a  # {MARK} so\nb\n", "import a\nb\n"),
        ("a.py", f"a\n    # {MARK} so\nb\n", "a\nb\n"),
        ("a.py", f"a\r\n# {MARK} so\r\nb\r\n", "a\r\nb\r\n"),
        ("a.py", f"a  # {MARK}", "a"),
        ("a.py", f"a\n# {MARK}", "a\n"),
        ("a.py", f"a  # type: ignore  # {MARK} so\n", "a  # type: ignore\n"),
        ("a.py", f"a  # {MARK} so  # noqa\n", "a  # noqa\n"),
        ("a.py", "a  # ros-lint: ignore[ROS201] so # ros-lint: ignore[ROS204]\n", "a  # ros-lint: ignore[ROS201] so\n"),
        ("a.xml", f"<a>\n  <b/> <!-- {MARK} so -->\n</a>", "<a>\n  <b/>\n</a>"),
        ("a.xml", f"<a>\n  <!-- {MARK} -->\n  <b/>\n</a>", "<a>\n  <b/>\n</a>"),
        ("a.xml", f"<!-- because\n  {MARK} so\n  -->\n<b/>", "<!-- because\n\n  -->\n<b/>"),
        ("CMakeLists.txt", f"foo(a #[[ {MARK} ]] b)\n", "foo(a b)\n"),
        ("CMakeLists.txt", f"foo(a#[=[{MARK}]=]b)\n", "foo(a b)\n"),
        ("a.cpp", f"int /* {MARK} so */ a;\n", "int a;\n"),
        ("a.cpp", f"int a; // NOLINT // {MARK} so\n", "int a; // NOLINT\n"),
        ("a.cpp", f"int a; /* NOLINT {MARK} so */\n", "int a; /* NOLINT */\n"),
        ("a.py", "# ros-lint: ignore[ROS201, ROS204,ROS301] so\n", "# ros-lint: ignore[ROS201, ROS301] so\n"),
    ],
)
def test_the_fix_removes_a_name_from_a_suppression(path: str, text_before: str, text_after: str) -> None:
    text = Text(path, text_before)
    suppression = next(s for s in collect(text) if any(name.text == "ROS204" for name in s.names))
    edit = suppression.without([name for name in suppression.names if name.text == "ROS204"])
    changed = edits.apply([Fix("", (edit,))], lambda _: text)[path]
    assert not any(name.text == "ROS204" for s in collect(Text(path, changed)) for name in s.names)
    assert changed == text_after
