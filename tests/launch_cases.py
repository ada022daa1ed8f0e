"""Helpers of the tests of launch collectors."""

from ros_lint.base.text import Text
from ros_lint.collectors.launch import collect as launch_files
from ros_lint.collectors.launch import detect as launch
from ros_lint.facts.launch import LaunchFile, LaunchReference


def collect(path: str, text: str) -> tuple[Text, LaunchFile]:
    source = Text(path, text)
    language = launch.is_launch_file(path, text)
    assert language is not None
    return source, launch_files.collect(source, language)


def summaries(source: Text, launch_file: LaunchFile) -> list[str]:
    """Return a summary of each reference. Checks that exact references have the exact span of their name."""
    for reference in launch_file.references:
        if reference.exact:
            assert source.slice(reference.span) == (reference.name or reference.package)
        assert reference.span.path == source.path
    return [summary(reference) for reference in launch_file.references]


def summary(reference: LaunchReference) -> str:
    mark = "?" if reference.conditional else ""
    return f"{reference.kind}{mark} {reference.package} {reference.name}".strip()
