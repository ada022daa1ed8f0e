"""The man page, the completion scripts and the metadata of the distribution."""

from __future__ import annotations

import importlib.util
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SPEC = importlib.util.spec_from_file_location("generate", ROOT / "packaging" / "generate.py")
assert SPEC
assert SPEC.loader
generate = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(generate)


def test_the_generated_files_are_up_to_date(request: pytest.FixtureRequest) -> None:
    if request.config.getoption("bless"):
        generate.main()
    for path, text in generate.files().items():
        assert (ROOT / path).read_text("utf-8") == text, "run pytest --bless"


def complete(*words: str) -> set[str]:
    """Return what Bash completes for the last word."""
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _ros_lint; printf "%s\\n" "${COMPREPLY[@]}"'
    command = ["bash", "-c", script, "bash", str(ROOT / generate.COMPLETIONS["bash"]), "ros-lint", *words]
    return set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())


def test_bash_completes_commands_options_rules_and_distributions() -> None:
    assert {"check", "graph", "--pedantic"} <= complete("")
    assert complete("--distro", "ja") == {"jazzy"}
    assert complete("--select", "uninstalled-la") == {"uninstalled-launch"}
    assert complete("rule", "uninstalled-la") == {"uninstalled-launch"}
    assert "mermaid" in complete("graph", "--format", "")
    assert "--pedantic" not in complete("graph", "--p")
    assert "refresh" in complete("index", "")
