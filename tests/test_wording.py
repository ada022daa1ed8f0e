from ros_lint.analysis.finding import Related
from ros_lint.analysis.wording import several
from ros_lint.base.suggestions import did_you_mean, few, is_meant, similar
from ros_lint.base.text import Span


def test_a_list_says_when_it_is_cut_short() -> None:
    assert few(["a"]) == "'a'"
    assert few(iter("abc")) == "'a', 'b', 'c'"
    assert few("abcde") == "'a', 'b', 'c' and 2 more"


def test_of_many_places_the_first_are_shown() -> None:
    places = [Related("here, too", Span("a.cpp", line, 1, line, 2)) for line in range(1, 7)]
    assert several(iter(places)) == tuple(places[:4])
    assert several(places[:1]) == tuple(places[:1])


def test_what_may_be_meant() -> None:
    assert similar("jazy", ["humble", "jazzy"]) == ["jazzy"]
    assert similar("jazy", ["humble", "jazzy"], 1, 0.95) == []
    assert did_you_mean([]) == is_meant([]) == ""
    assert is_meant(["a", "b"]) == "; did you mean 'a'?"
    assert did_you_mean(["a", "b"]) == "; did you mean 'a' or 'b'?"
    assert did_you_mean(["<a>"]) == "; did you mean <a>?"
    assert did_you_mean(["a"], ", ") == ", did you mean 'a'?"
