"""Functions and types about launch files: the programs they start, the files they include, the configurations they set."""

from typing import TYPE_CHECKING

from ros_lint.analysis.launch.arguments import ArgumentUse, SimilarRead, argument_use
from ros_lint.analysis.launch.branches import packages_of_every_branch
from ros_lint.analysis.launch.configurations import IncludeTree, include_tree
from ros_lint.analysis.launch.files import (
    InstalledPrograms,
    PackageLaunchFile,
    files_looked_up,
    installed_programs,
    is_excluded_from_install,
    is_launch_file,
    launch_suffix,
    node_references,
    nodes_started,
    only_installer,
    package_launch_files,
    references_by_name,
    rename_fix,
    run_launch_files,
    used_files,
)
from ros_lint.analysis.launch.includes import (
    MOST_RELATED,
    IncludeResolver,
    assigned_configurations,
    include_resolver,
    substitute,
)
from ros_lint.analysis.launch.parameter_checks import Undeclared, WrongType, undeclared, unmatched_nodes, wrong_types
from ros_lint.analysis.launch.parameter_files import NodeParameterFile, given_parameter_files, parameter_files_passed_on
from ros_lint.analysis.launch.remappings import UnusedRemapping, unused_remappings
from ros_lint.analysis.launch.runs import FailingExpression, PassedFile, expand_defaults, failing_expressions, passed_files
from ros_lint.analysis.launch.scopes import PlacedInclude, ScopeLeaks, includes, scope_leaks
from ros_lint.analysis.launch.tags import with_added_tags
from ros_lint.analysis.launch.workspace_files import launch_file
from ros_lint.collectors.conditional_text import are_consistent
from ros_lint.collectors.launch.detect import LAUNCH_FILE_NAMES
from ros_lint.collectors.symbolic_text import configurations, is_node_renaming, is_plain
from ros_lint.facts.launch import ACCEPTED_PROBLEMS, LAUNCH_RUNTIME, values_of_action, walk_actions

if TYPE_CHECKING:
    from ros_lint.collectors.launch.expansion import Started as Started  # noqa: PLC0414

__all__ = [
    "ACCEPTED_PROBLEMS",
    "LAUNCH_FILE_NAMES",
    "LAUNCH_RUNTIME",
    "MOST_RELATED",
    "ArgumentUse",
    "FailingExpression",
    "IncludeResolver",
    "IncludeTree",
    "InstalledPrograms",
    "NodeParameterFile",
    "PackageLaunchFile",
    "PassedFile",
    "PlacedInclude",
    "ScopeLeaks",
    "SimilarRead",
    "Undeclared",
    "UnusedRemapping",
    "WrongType",
    "are_consistent",
    "argument_use",
    "assigned_configurations",
    "configurations",
    "expand_defaults",
    "failing_expressions",
    "files_looked_up",
    "given_parameter_files",
    "include_resolver",
    "include_tree",
    "includes",
    "installed_programs",
    "is_excluded_from_install",
    "is_launch_file",
    "is_node_renaming",
    "is_plain",
    "launch_file",
    "launch_suffix",
    "node_references",
    "nodes_started",
    "only_installer",
    "package_launch_files",
    "packages_of_every_branch",
    "parameter_files_passed_on",
    "passed_files",
    "references_by_name",
    "rename_fix",
    "run_launch_files",
    "scope_leaks",
    "substitute",
    "undeclared",
    "unmatched_nodes",
    "unused_remappings",
    "used_files",
    "values_of_action",
    "walk_actions",
    "with_added_tags",
    "wrong_types",
]
