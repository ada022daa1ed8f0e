"""What the tests of the launch collectors share."""

from ros_lint.base.text import Text
from ros_lint.collectors.launch import collect as launch_files
from ros_lint.collectors.launch import detect as launch
from ros_lint.facts.launch import LaunchFile, LaunchReference


def collect(path: str, text: str) -> tuple[Text, LaunchFile]:
    source = Text(path, text)
    language = launch.is_launch_file(path, text)
    assert language is not None
    return source, launch_files.collect(source, language)


def said(source: Text, found: LaunchFile) -> list[str]:
    """Return the references in short, and check that what is exact is exact."""
    for reference in found.references:
        if reference.exact:
            assert source.slice(reference.span) == (reference.name or reference.package)
        assert reference.span.path == source.path
    return [short(reference) for reference in found.references]


def short(reference: LaunchReference) -> str:
    mark = "?" if reference.conditional else ""
    return f"{reference.kind}{mark} {reference.package} {reference.name}".strip()
