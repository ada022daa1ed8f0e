"""Case files of rules: what a failing case says, and that blessing does not hide it."""

from pathlib import Path

import pytest

from ros_lint.analysis.rule import Rule
from ros_lint.api import Confidence, Finding, Package, Severity, Workspace
from ros_lint.testing import Case, bless, differences, read_cases

CASES = """\
## A package is reported

`robot/package.xml`

```xml
<package format="3">  <!-- {want} -->
  <name>robot</name><version>1.0.0</version><description>A robot.</description>
  <maintainer email="a@b.org">A</maintainer><license>Apache-2.0</license>
</package>
```

```output
```
"""


def check(package: Package, workspace: Workspace) -> list[Finding]:
    place = package.start_of("package.xml")
    return [Finding(f"'{package.name}' is here", place, package.name, confidence=Confidence.MEDIUM)]


RULE = Rule("is-here", "ACME001", "no package is here", Severity.INFO, "1.0", "", package=check)


def case(folder: Path, want: str) -> Case:
    file = folder / "is-here.md"
    if want:
        file.write_text(CASES.format(want=want), "utf-8")
    (only,) = read_cases(file)
    return only


def test_blessing_rewrites_the_blocks_of_a_case_that_then_passes(tmp_path: Path) -> None:
    bless(case(tmp_path, 'want [medium] "is here"'), RULE)
    assert "info[ACME001 is-here]: 'robot' is here" in (tmp_path / "is-here.md").read_text("utf-8")
    assert list(differences(case(tmp_path, ""), RULE)) == []


@pytest.mark.parametrize(
    ("want", "message"),
    [
        ('want "is gone"', 'robot/package.xml:1: no finding here meets want "is gone"'),
        ('want [high] "is here"', 'robot/package.xml:1: no finding here meets want [high] "is here"'),
        ("", "robot/package.xml:1:1: unexpected [medium]: 'robot' is here"),
    ],
)
def test_blessing_fails_if_a_want_is_not_met(tmp_path: Path, want: str, message: str) -> None:
    unblessed = case(tmp_path, want or "no expectation")
    with pytest.raises(AssertionError, match="the blocks are rewritten, but the case fails") as failure:
        bless(unblessed, RULE)
    assert message in str(failure.value).splitlines()
    assert "'robot' is here" in (tmp_path / "is-here.md").read_text("utf-8").rpartition("```output")[2]
