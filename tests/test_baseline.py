"""Baselines: known findings are hidden, and new and gone findings are reported."""

import filecmp
import json
import os
import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ros_lint.analysis.finding import Confidence, Finding, Severity
from ros_lint.analysis.rule import Rule
from ros_lint.base.text import Span
from ros_lint.engine import baseline
from ros_lint.engine.baseline import BaselineError
from ros_lint.engine.report import UNSURE, Crash, HiddenCount, Issue, Report
from ros_lint.workspace.target import TargetDistro
from tests.test_cli import DEMO, HEADLINES, run

pytestmark = pytest.mark.slow

PLACE = Span("a/package.xml", 1, 1, 1, 2)


def rule(name: str) -> Rule:
    return Rule(name=name, code=f"X-{name}", summary="s", severity=Severity.WARNING, since="0.1", doc="d", package=lambda *_: ())


def issue(name: str, package: str, subject: str, *, sure: bool = True) -> Issue:
    finding = Finding("m", PLACE, subject, confidence=Confidence.HIGH if sure else Confidence.MEDIUM)
    return Issue(rule(name), package, finding)


def report(*issues: Issue, ran: tuple[str, ...] = ("one", "two"), hidden: tuple[HiddenCount, ...] = ()) -> Report:
    return Report(issues, tuple(map(rule, ran)), 1, TargetDistro("jazzy", "--distro"), "2026-01-01", "0", hidden)


def kept(tmp_path: Path, found: Report, *folders: str) -> baseline.Baseline:
    """Return what is read of a file with the findings of a report."""
    file = tmp_path / "known.json"
    baseline.write(str(file), found, folders or (".",))
    return baseline.read(str(file))


def issues_of(words: st.SearchStrategy[str]) -> st.SearchStrategy[list[Issue]]:
    return st.lists(st.builds(issue, st.sampled_from(["one", "two"]), words, words, sure=st.booleans()), max_size=12)


found = issues_of(st.text(max_size=2))


@given(issues_of(st.text(st.characters(), max_size=4)))  # lone bytes, too
def test_a_baseline_hides_exactly_its_findings(tmp_path_factory: pytest.TempPathFactory, issues: list[Issue]) -> None:
    known = kept(tmp_path_factory.mktemp("known"), report(*issues))
    left = known.hide_known(report(*issues), "known.json", (".",))
    assert (left.issues, left.warnings) == ((), ())
    assert left.hidden == ((HiddenCount("listed in known.json", len(issues)),) if issues else ())


@given(found, found)
def test_findings_are_new_if_there_are_more_than_listed(
    tmp_path_factory: pytest.TempPathFactory, before: list[Issue], after: list[Issue]
) -> None:
    left = kept(tmp_path_factory.mktemp("known"), report(*before)).hide_known(report(*after), "known.json", (".",))
    keys = [(one.rule.name, one.package, one.finding.subject) for one in before]
    for one in after:
        key = one.rule.name, one.package, one.finding.subject
        now = sum(key == (other.rule.name, other.package, other.finding.subject) for other in after)
        assert (one in left.issues) == (now > keys.count(key))


def test_findings_that_no_longer_occur_give_a_warning(tmp_path: Path) -> None:
    known = kept(tmp_path, report(issue("one", "a", "x"), issue("one", "a", "x"), issue("two", "b", "y")))
    left = known.hide_known(report(issue("one", "a", "x")), "known.json", (".",))
    assert left.warnings == ("2 findings in known.json no longer occur; --write-baseline removes them",)
    left = known.hide_known(report(issue("one", "a", "x"), issue("two", "b", "y")), "known.json", (".",))
    assert left.warnings == ("1 finding in known.json no longer occurs; --write-baseline removes it",)


def test_findings_of_rules_that_did_not_run_are_not_gone(tmp_path: Path) -> None:
    known = kept(tmp_path, report(issue("one", "a", "x"), issue("two", "b", "y", sure=False)))
    assert not known.hide_known(report(ran=("two",), hidden=(HiddenCount(UNSURE, 1),)), "k", (".",)).warnings
    assert not known.hide_known(report(), "k", ("src",)).warnings
    crashed = report(ran=("one",))._replace(crashes=(Crash("one", "a", "ValueError"),))
    assert not known.hide_known(crashed, "k", (".",)).warnings
    assert known.hide_known(report(ran=("two",)), "k", (".",)).warnings


def test_the_findings_of_another_report_can_be_hidden() -> None:
    old, new = issue("one", "a", "x"), issue("two", "b", "y", sure=False)
    known = baseline.of(report(old, old))
    left = known.hide_known(report(old, old, new, hidden=(HiddenCount(UNSURE, 1),)), "main", ("src",), where="already in")
    assert (left.issues, left.warnings) == ((new,), ())
    assert left.hidden == (HiddenCount(UNSURE, 1), HiddenCount("already in main", 2))
    warned = known.hide_known(report()._replace(warnings=("first",)), "main", ())
    assert warned.warnings == ("first", "2 findings in main no longer occur; --write-baseline removes them")
    assert known.hide_known(report(), "main", ("src",)).warnings == ()


def test_findings_of_low_confidence_are_gone_if_all_are_shown(tmp_path: Path) -> None:
    known = kept(tmp_path, report(issue("one", "a", "x", sure=False)))
    hidden = (HiddenCount("suppressed by comments", 1),)
    assert known.hide_known(report(hidden=hidden), "k", (".",)).warnings
    assert not known.hide_known(report(hidden=(*hidden, HiddenCount(UNSURE, 1))), "k", (".",)).warnings


def test_a_baseline_that_cannot_be_read_or_written_is_reported_with_its_path(tmp_path: Path) -> None:
    place = str(tmp_path / "nowhere" / "known.json")
    with pytest.raises(BaselineError, match="known.json: No such file or directory; --write-baseline creates the file$"):
        baseline.read(place)
    with pytest.raises(BaselineError, match="known.json: cannot be written: No such file or directory; nothing was changed$"):
        baseline.write(place, report(), (".",))


def test_the_file_has_a_line_per_key_and_no_places(tmp_path: Path) -> None:
    moved = issue("two", "b", "ü")._replace(finding=Finding("other words", Span("z", 9, 9, 9, 9), "ü"))
    text = baseline.text(report(issue("two", "b", "ü"), issue("one", "a", "x"), issue("one", "a", "x", sure=False)), ("src",))
    assert text == baseline.text(report(issue("one", "a", "x"), moved, issue("one", "a", "x", sure=False)), ("src",))
    assert text.splitlines()[1:-2] == [
        ' "folders": [',
        '  "src"',
        " ],",
        ' "known": [',
        '  {"rule": "one", "package": "a", "subject": "x", "count": 2, "sure": false},',
        '  {"rule": "two", "package": "b", "subject": "ü", "count": 1, "sure": true}',
    ]


KNOWN = '{"folders": [], "known": [{"rule": "", "package": "", "subject": "", "count": 1, "sure": true}]}'


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "known.json:1: not valid JSON"),
        ('{\n"known": [', "known.json:2: not valid JSON"),
        ("[]", "known.json: not a baseline file"),
        ('{"folders": [], "known": [{"rule": "one"}]}', "known.json: not a baseline file"),
        ('{"folders": [], "known": {"rule": "one"}}', "known.json: not a baseline file"),
        ('{"folders": [], "known": [{"rule": "", "package": "", "subject": "", "count": "many", "sure": 1}]}', "known.json: not"),
        *(
            (KNOWN.replace("1", count), "known.json: not a baseline")
            for count in ("1e999", "NaN", "-1", "0", "1e9", "9" * 5000, '"1"')
        ),
        ("[" * 100_000, "known.json: not a baseline file"),
        (b"\xff\xfe", "known.json: not a baseline file"),
    ],
)
def test_an_invalid_file_is_reported_with_its_path(tmp_path: Path, text: str | bytes, complaint: str) -> None:
    file = tmp_path / "known.json"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(BaselineError) as raised:
        baseline.read(str(file))
    assert str(raised.value).startswith(f"{tmp_path}{os.sep}{complaint}")


def test_irregular_and_large_files_are_reported_with_their_path(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "large").write_text(KNOWN + " " * (64 << 20))
    for name, reason in (("fifo", "not a regular file"), ("large", "65 MB is more than the limit of 64 MB")):
        with pytest.raises(BaselineError, match=f"{name}: {reason}; --write-baseline creates the file"):
            baseline.read(str(tmp_path / name))
    (tmp_path / "good").write_text(KNOWN)
    assert baseline.read(str(tmp_path / "good")).known


@pytest.fixture
def demo(tmp_path: Path) -> Path:
    return Path(shutil.copytree(DEMO, tmp_path / "ws"))


def test_a_workspace_with_known_findings_is_clean_until_there_is_a_new_one(demo: Path) -> None:
    (demo / "ros-lint.toml").write_text('baseline = "known.json"\n')
    process = run("--write-baseline", cwd=demo)
    assert (process.returncode, process.stdout) == (0, "")
    assert "wrote 6 findings to " in process.stderr
    assert {entry["rule"] for entry in json.loads((demo / "known.json").read_text())["known"]} == HEADLINES
    process = run(cwd=demo / "src" / "rover_teleop")  # the file lies beside the settings, wherever one is
    assert process.returncode == 0
    assert "1 finding listed in known.json" in process.stdout
    assert "than there" not in process.stderr
    source = demo / "src" / "rover_driver" / "src" / "driver_node.cpp"
    source.write_text(f"#include <nav_msgs/msg/path.hpp>\n{source.read_text()}")
    process = run("--format", "json", cwd=demo)
    assert process.returncode == 1
    (finding,) = json.loads(process.stdout)["findings"]
    assert (finding["rule"], finding["subject"]) == ("undeclared-dependency", "nav_msgs")


def test_the_cache_does_not_change_the_effect_of_a_baseline(demo: Path, tmp_path: Path) -> None:
    env = {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    assert run(demo, env=env).returncode == 1
    known = ("--baseline", tmp_path / "known.json")
    assert run(demo, *known, "--write-baseline", env=env).returncode == 0
    assert run(demo, *known, env=env).returncode == 0
    assert run(demo, env=env).returncode == 1


def test_known_findings_are_fixed(demo: Path) -> None:
    known = ("--baseline", demo / "known.json")
    run(demo, *known, "--write-baseline")
    process = run(demo, *known, "--fix")
    assert process.returncode == 0
    assert "4 findings in known.json no longer occur" in process.stderr


def test_conflicting_options_are_rejected(demo: Path, tmp_path: Path) -> None:
    for arguments, complaint in (
        (("--write-baseline",), "--write-baseline needs a file"),
        (("--baseline", "k.json", "--write-baseline", "--diff"), "--diff writes no files"),
        (("--baseline", "k.json"), "k.json: No such file or directory; --write-baseline creates the file"),
        (("--baseline", "k.json", "--fix"), "k.json: No such file or directory"),
        (("--baseline", tmp_path / "no" / "k.json", "--write-baseline"), "k.json: cannot be written"),
    ):
        process = run(demo, *arguments, cwd=tmp_path)
        assert process.returncode == 2, arguments
        assert complaint in process.stderr
        assert not (tmp_path / "k.json").exists()
    manifest = "src/rover_driver/package.xml"
    assert filecmp.cmp(DEMO / manifest, demo / manifest, shallow=False)  # nothing was fixed before the error
    (tmp_path / "empty").mkdir()
    process = run(tmp_path / "empty", "--baseline", "k.json", "--write-baseline", cwd=tmp_path)
    assert process.returncode == 2
    assert "k.json: not written: no package found below" in process.stderr
    assert not (tmp_path / "k.json").exists()
