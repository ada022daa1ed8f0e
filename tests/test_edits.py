"""Edits are applied to texts and files."""

import os
from pathlib import Path
from random import Random

import pytest

from ros_lint.analysis.finding import Fix
from ros_lint.base.diff import unified
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span, Text
from ros_lint.base.tree import DiskTree, MemoryTree
from ros_lint.engine import edits

SOURCE = Text("f", "one\r\ntwo\nthree")


def fix(*changes: tuple[int, int, str]) -> Fix:
    return Fix("change", tuple(Edit(SOURCE.span(start, end), text) for start, end, text in changes))


def applied(*fixes: Fix) -> str:
    return edits.apply(fixes, lambda path: SOURCE)["f"]


def test_a_blank_line_goes_with_the_lines_between_two_blank_lines() -> None:
    lines = ["a\n", "\n", "b\n", "  c\n", "\n", "d\n"]
    source = Text("f", "".join(lines))

    def removed(*indices: int) -> str:
        places = [(len("".join(lines[:index])), len("".join(lines[: index + 1]))) for index in indices]
        return edits.apply([Fix("", (Edit(source.span(*place), ""),)) for place in places], lambda path: source)["f"]

    assert removed(2, 3) == "a\n\nd\n"
    assert removed(2) == "a\n\n  c\n\nd\n"
    assert removed(3) == "a\n\nb\n\nd\n"
    assert removed(0) == "\nb\n  c\n\nd\n"


def test_a_line_that_loses_its_text_stays() -> None:
    source = Text("f", "a\n\nbc\n\nd\n")
    for start in (3, 4):
        edited = edits.apply([Fix("", (Edit(source.span(start, 5), ""),))], lambda path: source)["f"]
        assert edited == source.text[:start] + source.text[5:]


def test_inserted_lines_end_like_the_line_at_their_place() -> None:
    """In a file with both kinds of line ends."""
    source = Text("f", "one\r\ntwo\nthree\r\n")
    fixes = [Fix("", (Edit(source.span(place, place), "a\n"),)) for place in (0, 5, 9, 16)]
    assert edits.apply(fixes, lambda path: source)["f"] == "a\r\none\r\na\ntwo\na\r\nthree\r\na\r\n"
    empty = Text("f", "\r\ntwo\n")
    first, last = (Fix("", (Edit(empty.span(place, place), "a\n"),)) for place in (0, 6))
    assert edits.apply([first, last], lambda path: empty)["f"] == "a\r\n\r\ntwo\na\n"


def test_edits_do_not_shift_each_other() -> None:
    assert applied(fix((0, 3, "ONE"), (9, 14, "3")), fix((5, 5, "a "), (5, 5, "b "))) == "ONE\r\na b two\n3"


def test_inserted_lines_have_the_line_ends_of_the_file() -> None:
    source = Text("f", "one\r\ntwo\r\n")
    change = Fix("", (Edit(source.span(5, 5), "a\nb\r\n"),))
    assert edits.apply([change], lambda path: source)["f"] == "one\r\na\r\nb\r\ntwo\r\n"


def test_inserted_lines_are_indented_by_tabs_like_their_neighbours() -> None:
    source = Text("f", "a(\n\t\tone\n  two)\n")
    changes = [Fix("", (Edit(source.span(end, end), "\n  new"),)) for end in (source.text.index("\n  t"), source.text.index(")"))]
    assert edits.apply(changes, lambda path: source)["f"] == "a(\n\t\tone\n\t\tnew\n  two\n  new)\n"


def test_an_edit_of_two_fixes_is_applied_once() -> None:
    assert applied(fix((0, 0, "x")), fix((0, 0, "x"))) == "xone\r\ntwo\nthree"


def test_a_fix_that_overlaps_an_earlier_one_is_not_chosen() -> None:
    first, second, third = fix((0, 3, "")), fix((1, 2, "x"), (9, 9, "y")), fix((3, 3, "z"))
    assert edits.choose([first, second, third]) == (first, third)
    assert edits.choose([third, first]) == (third, first)


def test_an_insertion_inside_of_replaced_text_is_an_overlap() -> None:
    deletion, insertion = fix((0, 3, "")), fix((1, 1, "x"))
    assert edits.choose([deletion, insertion]) == (deletion,)
    assert edits.choose([insertion, deletion]) == (insertion,)
    elsewhere = Fix("", tuple(edit._replace(span=edit.span._replace(path="g")) for edit in insertion.edits))
    assert edits.choose([deletion, elsewhere]) == (deletion, elsewhere)


def _overlap(first: Edit, second: Edit) -> bool:
    left, right = first.span, second.span
    return left.path == right.path and left[1:3] < right[3:] and right[1:3] < left[3:]


@pytest.mark.parametrize("seed", range(300))
def test_the_chosen_fixes_are_those_that_overlap_no_earlier_one(seed: int) -> None:
    random = Random(seed)
    fixes: list[Fix] = []
    for _ in range(12):
        own: list[Edit] = []
        for _ in range(random.randrange(1, 4)):
            start, end = sorted((random.randrange(1, 4), random.randrange(1, 9)) for _ in range(2))
            end = random.choice((start, end))
            edit = Edit(Span(random.choice("fg"), *start, *end), random.choice("xy"))
            if not any(_overlap(edit, other) for other in own):
                own.append(edit)
        fixes.append(Fix("", tuple(own)))
    expected: list[Fix] = []
    for fix in fixes:
        taken = [edit for other in expected for edit in other.edits]
        if not any(_overlap(edit, other) for edit in fix.edits if edit not in taken for other in taken):
            expected.append(fix)
    assert edits.choose(fixes) == tuple(expected)


def test_an_edit_that_two_fixes_share_is_no_overlap() -> None:
    first, second = fix((0, 3, "x")), fix((0, 3, "x"), (9, 14, "y"))
    assert edits.choose([first, second]) == (first, second)


@pytest.mark.parametrize(
    ("put", "expected"),
    [
        ([(5, "a", "\na\n"), (5, "b", "\nb\n")], "\na\nb\n"),
        ([(5, "a", "a\n\n"), (5, "b", "b\n\n")], "a\nb\n\n"),
        ([(5, "a", "\r\na\r\n"), (5, "b", "\r\nb\r\n")], "\r\na\r\nb\r\n"),
        ([(5, "a", "\na\n"), (7, "b", "\nb\n")], "\na\n\nb\n"),
        ([(5, "a", "a\n\n"), (7, "b", "\nb\n")], "a\n\nb\n"),
        ([(0, "", "a\n"), (0, "", "b\n")], "b\na\n"),
        ([(0, "", "\na\n"), (0, "", "\nb\n")], "\nb\n\na\n"),
        ([(1, "a", "\na\n"), (1, "b", "\nb\n")], "\na\nb\n"),
        ([(5, "a", "a\n\n"), (7, "b", "b\n")], "a\n\nb\n"),
        ([(5, "a", "a\r\n\r\n"), (5, "b", "b\r\n\r\n")], "a\r\nb\r\n\r\n"),
        ([(5, "a", "a\r\n\r\n"), (7, "b", "\r\nb\r\n")], "a\r\n\r\nb\r\n"),
        ([(5, "a", "a\r\r"), (7, "b", "\rb\r")], "a\r\rb\r"),
    ],
)
def test_a_group_of_insertions_is_separated_by_one_blank_line(put: list[tuple[int, str, str]], expected: str) -> None:
    start = SOURCE.span(5, 5)
    fixes = [Fix("", (Edit(start, text, kind, order),)) for kind, order, text in reversed(put)]
    assert edits.choose(fixes) == tuple(fixes)
    assert edits.apply(fixes, lambda path: SOURCE)["f"] == f"one\r\n{expected}two\nthree"


def test_a_character_that_the_encoding_lacks_is_an_error() -> None:
    source = Text("f", "é", "iso8859-1")
    assert edits.encode({"f": "éa"}, lambda path: source) == {"f": b"\xe9a"}
    with pytest.raises(edits.EditError, match="f: its encoding .* cannot represent '漢'"):
        edits.encode({"f": "漢"}, lambda path: source)


def test_files_are_replaced_with_their_permissions(tmp_path: Path) -> None:
    target = tmp_path / "real"
    target.write_bytes(b"old")
    target.chmod(0o755)
    (tmp_path / "link").symlink_to("real")
    edits.write_all(str(tmp_path), {"link": b"new"}, {"link": b"old"})
    assert target.read_bytes() == b"new"
    assert target.stat().st_mode & 0o777 == 0o755
    assert (tmp_path / "link").is_symlink()
    assert sorted(os.listdir(tmp_path)) == ["link", "real"]


@pytest.mark.parametrize("what", ["file", "folder"])
def test_a_read_only_file_or_folder_prevents_all_changes(tmp_path: Path, what: str) -> None:
    (tmp_path / "a").write_bytes(b"old")
    (tmp_path / "d").mkdir()
    (tmp_path / "d" / "b").write_bytes(b"old")
    place = tmp_path / "d" / "b" if what == "file" else tmp_path / "d"
    mode = place.stat().st_mode
    place.chmod(0o555 if what == "folder" else 0o444)
    try:
        with pytest.raises(edits.EditError, match="d/b: cannot be written: it is read-only; nothing was changed"):
            edits.write_all(str(tmp_path), {"a": b"new", "d/b": b"new"}, {"a": b"old", "d/b": b"old"})
    finally:
        place.chmod(mode)
    assert (tmp_path / "a").read_bytes() == b"old"


def test_a_failing_disk_keeps_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_bytes(b"old")

    def full(*_: object) -> None:
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(edits.EditError, match="a: cannot be written: No space left on device"):
        edits.write_all(str(tmp_path), {"a": b"new"}, {"a": b"old"})
    assert (tmp_path / "a").read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["a"]


def test_a_file_is_created(tmp_path: Path) -> None:
    text = edits.text_of(DiskTree(str(tmp_path)), "new")
    changed = edits.apply([Fix("", (Edit(Span("new", 1, 1, 1, 1), "a\n"),))], lambda _: text)
    edits.write_all(str(tmp_path), edits.encode(changed, lambda _: text), {})
    assert (tmp_path / "new").read_bytes() == b"a\n"
    assert (tmp_path / "new").stat().st_mode & 0o777 == 0o644
    assert unified("new", None, "a\n") == "--- /dev/null\n+++ b/new\n@@ -0,0 +1 @@\n+a\n"


def test_a_file_that_cannot_be_read_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    tree = DiskTree(str(tmp_path))
    with pytest.raises(edits.EditError, match="^folder: cannot be read: ."):
        edits.text_of(tree, "folder")
    assert edits.text_of(tree, "new").text == ""


def test_an_error_without_a_number_gives_its_reason() -> None:
    class Refusing(MemoryTree):
        def read(self, path: str) -> bytes:
            raise OSError("too large")

    with pytest.raises(edits.EditError, match="^f: cannot be read: too large$"):
        edits.text_of(Refusing({}), "f")


def test_a_device_is_written_directly() -> None:
    edits.write(os.devnull, b"data")
    assert not os.path.isfile(os.devnull)
    with pytest.raises(edits.EditError, match="^/dev/full: cannot be written: No space left on device$"):
        edits.write("/dev/full", b"data")


def test_a_file_in_a_missing_folder_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(edits.EditError, match="a: cannot be written: No such file or directory; nothing was changed$"):
        edits.write(str(tmp_path / "nowhere" / "a"), b"data")


def test_a_fix_needs_all_of_its_edits() -> None:
    edit = Edit(Span("a", 1, 1, 1, 1), "x")
    assert Fix.of("write x", edit, safe=False) == Fix("write x", (edit,), safe=False)
    assert Fix.of("write x", edit, edit) == Fix("write x", (edit, edit))
    assert Fix.of("write x", edit, None) is None
    assert Fix.of("write x") is None
