"""Conditions compared with catkin_pkg, and their evaluation with three truth values."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import pytest
from catkin_pkg.condition import evaluate_condition
from hypothesis import given, settings
from hypothesis import strategies as st

from ros_lint.base.text import Text
from ros_lint.collectors.manifest import conditions
from ros_lint.collectors.manifest.collect import collect

VARIABLES = ["ROS_VERSION", "ROS_DISTRO", "A", "B_1", "and"]
VALUES = ["1", "2", "10", "humble", "jazzy", "", "x y", "-", "and", "a\tb"]

terms = st.one_of(
    st.sampled_from(VARIABLES).map(lambda name: f"${name}"),
    st.sampled_from(["1", "2", "10", "humble", "and", "or", "-", "a-b", "_"]),
    st.sampled_from(VALUES).map(lambda value: f'"{value}"'),
    st.sampled_from([*VALUES, '"', r"a\tb", r"\n", r"\0", r"\x42", r"\73", r"\102"]).map(lambda value: f"'{value}'"),
)
blanks = st.sampled_from(["", " ", "  ", "\n", "\t"])
operators = st.sampled_from(["==", "!=", "<", "<=", ">", ">="])
comparisons = st.tuples(terms, blanks, operators, blanks, terms).map("".join)
valid = st.recursive(
    comparisons,
    lambda inner: st.one_of(
        st.tuples(inner, blanks, st.sampled_from(["and", "or"]), blanks, inner).map("".join),
        st.tuples(st.just("("), blanks, inner, blanks, st.just(")")).map("".join),
    ),
    max_leaves=4,
)
pieces = [*"$=!<>()\"' \té\\", "$A", "$ROS_DISTRO", "1", "1.0", "==", "and", "or", "not"]
broken = st.one_of(
    st.lists(st.sampled_from(pieces), max_size=8).map("".join),
    st.tuples(valid, st.integers(0, 60), st.sampled_from(["", *pieces])).map(lambda t: t[0][: t[1]] + t[2] + t[0][t[1] + 1 :]),
)
contexts = st.dictionaries(st.sampled_from(VARIABLES), st.sampled_from(VALUES))


def by_catkin_pkg(text: str, context: Mapping[str, str]) -> bool | None:
    """Return the value in catkin_pkg, None if the condition does not parse."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        try:
            return bool(evaluate_condition(text, context))
        except ValueError:
            return None


def by_ros_lint(text: str, context: Mapping[str, str]) -> bool | None:
    try:
        condition = conditions.parse(text)
    except conditions.ConditionError:
        return None
    answer = conditions.evaluate(condition, {**dict.fromkeys(conditions.variables(condition), ""), **context})
    assert answer is not None
    return answer


@settings(max_examples=400)
@given(st.one_of(valid, broken), contexts)
def test_conditions_have_the_value_of_catkin_pkg(text: str, context: dict[str, str]) -> None:
    assert by_ros_lint(text, context) == by_catkin_pkg(text, context)


@given(broken)
def test_error_offsets_are_inside_the_text(text: str) -> None:
    try:
        conditions.parse(text)
    except conditions.ConditionError as error:
        offset = error.offset
    else:
        offset = 0
    assert 0 <= offset <= len(text)


@settings(max_examples=400)
@given(valid, contexts, st.lists(st.lists(st.sampled_from(VALUES), min_size=5, max_size=5), min_size=1, max_size=5))
def test_a_certain_value_holds_for_every_value_of_the_unknown_variables(
    text: str, context: dict[str, str], completions: list[list[str]]
) -> None:
    certain = conditions.truth(text, context)
    answers = {by_catkin_pkg(text, {**dict(zip(VARIABLES, values, strict=True)), **context}) for values in completions}
    if certain is not None:
        assert answers == {certain}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", True),
        (" ", None),
        ("$ROS_VERSION == 2", True),
        ("$ROS_VERSION == 1", False),
        ("$UNKNOWN == 2", None),
        ("$ROS_VERSION == 2 or $UNKNOWN == 2", True),
        ("$ROS_VERSION == 1 or $UNKNOWN == 2", None),
        ("$ROS_VERSION == 1 and $UNKNOWN == 2", False),
        ("$UNKNOWN == 2 and $ROS_VERSION == 2", None),
        ("$ROS_VERSION == 1 or $ROS_VERSION == 2 and ($UNKNOWN == 1 or $ROS_DISTRO == jazzy)", True),
        ("10 < 9", True),
        ("'$ROS_VERSION' == 2", False),
        ("$ROS_VERSION", None),
    ],
)
def test_truth_of_conditions(text: str, expected: bool | None) -> None:
    assert conditions.truth(text, {"ROS_VERSION": "2", "ROS_DISTRO": "jazzy"}) is expected


@pytest.mark.parametrize(
    ("text", "message", "offset"),
    [
        ("", "expected a $variable, a word or a quoted string", 0),
        ("$A == ", "expected a $variable, a word or a quoted string", 6),
        ("$A", "expected a comparison such as ==", 2),
        ("$A == 1 && $B == 2", 'expected "and", "or" or the end', 8),
        ("($A == 1", 'expected "and", "or" or ")"', 8),
        ("\t$A == 1.5", 'expected "and", "or" or the end', 8),
        ("(" * 30 + "$A == 1" + ")" * 30, "too many parentheses", 20),
    ],
)
def test_errors_contain_the_place(text: str, message: str, offset: int) -> None:
    with pytest.raises(conditions.ConditionError) as raised:
        conditions.parse(text)
    assert (raised.value.message, raised.value.offset) == (message, offset)


def test_variables_of_conditions() -> None:
    assert conditions.variables(conditions.parse("$A == b or ($C != '$D' and $A == 1)")) == {"A", "C"}


MANIFEST = """<package format="3"><name>p</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.cc">m</maintainer><license>l</license>{}</package>"""


def test_build_types_and_condition_problems_of_a_manifest() -> None:
    manifest = collect(
        Text(
            "package.xml",
            MANIFEST.format(
                "<depend condition='$A'>a</depend><depend condition=''>b</depend><depend condition='$A == 1'>c</depend>"
                "<export><build_type condition='$A == 1'>catkin</build_type><build_type condition='$B == 1'>ament_cmake"
                "</build_type><build_type condition='1 == 2'>cmake</build_type><other condition='x y'/></export>"
            ),
        )
    )
    assert conditions.build_types(manifest, {"A": "1"}) == (("catkin", True), ("ament_cmake", None))
    assert conditions.build_types(manifest, {"A": "2", "B": "1"}) == (("ament_cmake", True),)
    assert [problem.message for problem in conditions.problems(manifest)] == [
        "condition '$A' of <depend> does not parse: at character 3, expected a comparison such as ==",
        "condition of <depend> is empty; remove the attribute",
        "condition 'x y' of <other> does not parse: at character 3, expected a comparison such as ==",
    ]
