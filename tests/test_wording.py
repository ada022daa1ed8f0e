from ros_lint.analysis.finding import Related
from ros_lint.analysis.wording import first_related
from ros_lint.base.suggestions import ask_if_meant, did_you_mean, shorten_list, similar_names
from ros_lint.base.text import Span


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
