"""Names that resemble an unknown name, also among many names."""

from __future__ import annotations

from itertools import count

import pytest

from ros_lint.base.suggestions import similar_names


@pytest.mark.parametrize("number_of_names", [50, 150, 3_000])
def test_a_similar_name_is_found_among_many(number_of_names: int) -> None:
    known = [f"argument_{number}" for number in range(number_of_names)]
    for wrong, meant in (("argumnet_17", "argument_17"), ("argument_4x", "argument_4"), ("arguments_38", "argument_38")):
        assert meant in similar_names(wrong, known, 3, 0.8)
        assert similar_names(wrong, known) == similar_names(wrong, reversed(known))
    assert similar_names("camera", known) == []
    assert similar_names("camera", [*known, "camera_left", "camra", "cam"], 2) == ["camra", "camera_left"]


def test_no_similar_name_is_searched_among_too_many() -> None:
    known = (f"argument_{number}" for number in count())
    assert similar_names("argumnet_17", known) == []
