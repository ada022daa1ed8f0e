"""Functions about the paths and kinds of files."""

from ros_lint.analysis.package_files import files_by_name
from ros_lint.base.auxiliary_files import is_auxiliary, is_for_tests
from ros_lint.base.paths import folders_of
from ros_lint.base.text import file_start
from ros_lint.collectors.suffixes import HEADERS, INTERFACES

__all__ = [
    "HEADERS",
    "INTERFACES",
    "file_start",
    "files_by_name",
    "folders_of",
    "is_auxiliary",
    "is_for_tests",
]
