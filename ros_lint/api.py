"""Everything a rule may import."""

from typing import TYPE_CHECKING

from ros_lint.analysis.build import cmake_edits
from ros_lint.analysis.build.commands import (
    ENDS,
    EXPORTING_PLUGINS,
    FINDS_TESTS,
    LINTERS,
    REGISTERING,
    config_names,
    evaluated_name,
    has_extras,
    installed_targets,
    opaque_except_undefined_targets,
    stops_early,
    unguarded_tests,
)
from ros_lint.analysis.build.targets import (
    files_using_client_library,
    has_header,
    install_arguments,
    installed_to_bin_only,
    installs_built,
    is_declared_shared,
    is_optional_target,
    libraries_in_libexec,
    library_calls,
    library_registering,
    may_run_built,
    never_installed_nodes,
    node_targets,
    partly_installed_nodes,
    programs_built,
    stem,
)
from ros_lint.analysis.dependencies.declared_closure import declared_closure, provided_transitively
from ros_lint.analysis.dependencies.find_package import (
    find_package_closure,
    finds_declared,
    macro_packages,
    names_searched,
    partial_closure,
)
from ros_lint.analysis.dependencies.load_bearing import LostProvision, needed_transitively, unused_find_packages
from ros_lint.analysis.dependencies.needs import Need, needs, optional_needs
from ros_lint.analysis.dependencies.remedy import Remedy, availability_remark, is_unresolvable_key, naming_fix, remedy
from ros_lint.analysis.dependencies.tags import add_dependency, change_dependency, remove_dependency, tag_for
from ros_lint.analysis.dependencies.traceless import (
    PYTHON_LIKE,
    has_programs,
    is_library,
    is_mostly_runtime,
    may_be_used_without_trace,
    usage_is_visible,
)
from ros_lint.analysis.dependencies.undeclared import (
    exists_in_any_distro,
    is_declared_misspelled,
    is_part_of_launch,
    manifest_is_complete,
    provided_in_other_distros,
    undeclared,
)
from ros_lint.analysis.dependencies.unknown_closure import may_provide
from ros_lint.analysis.dependencies.unresolved import (
    UnresolvedDependency,
    declared_names,
    intended_names,
    is_used_in_sources,
    misspelled_names,
    resembles_ament_package,
    undeclared_match,
    unresolved,
)
from ros_lint.analysis.finding import Confidence, Finding, Fix, Related, Severity
from ros_lint.analysis.graph.cycles import Cycle, cycles
from ros_lint.analysis.graph.dependency_graph import Edge, Graph, Reason, dependency_graph
from ros_lint.analysis.launch.configurations import IncludeTree, read_sites, required_configurations
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
    package_launch_files,
    references_by_name,
    rename_fix,
    used_files,
)
from ros_lint.analysis.launch.includes import IncludeResolver, assigned_configurations, include_resolver, substitute
from ros_lint.analysis.launch.parameter_files import NodeParameterFile, ParameterFiles
from ros_lint.analysis.launch.runs import FailingExpression, PassedFile, expand_defaults, failing_expressions, passed_files
from ros_lint.analysis.launch.scopes import PlacedInclude, ScopeLeaks, includes
from ros_lint.analysis.memo import cached_by_package, cached_by_workspace
from ros_lint.analysis.rule import Rule
from ros_lint.analysis.wording import first_related
from ros_lint.base.auxiliary_files import is_auxiliary, is_for_tests
from ros_lint.base.edit import Edit
from ros_lint.base.paths import folders_of
from ros_lint.base.suggestions import ask_if_meant, did_you_mean, shorten_list, similar_names
from ros_lint.base.text import Span, file_start
from ros_lint.collectors.interfaces import naming as interface_names
from ros_lint.collectors.launch.detect import LAUNCH_FILE_NAMES
from ros_lint.collectors.manifest import conditions
from ros_lint.collectors.manifest import edits as manifest_edits
from ros_lint.collectors.python.versions import STANDARD_LIBRARY, too_new
from ros_lint.collectors.setup_py import edits as setup_edits
from ros_lint.collectors.suffixes import HEADERS, INTERFACES
from ros_lint.collectors.symbolic_text import are_consistent, configurations, is_node_renaming, is_plain
from ros_lint.facts.build import (
    BuildScript,
    Component,
    InstalledFile,
    PluginClass,
    PluginFile,
    PluginLibrary,
    ScriptFile,
    UninstalledImport,
)
from ros_lint.facts.cmake import BuildTarget, Call
from ros_lint.facts.launch import (
    LaunchAction,
    LaunchCondition,
    LaunchFile,
    LaunchReference,
    LaunchValue,
    values_of_action,
    walk_actions,
)
from ros_lint.facts.manifest import Depend, Element, Manifest, Role
from ros_lint.facts.setup_py import EditableList, EntryPoint, PythonModule
from ros_lint.facts.sources import MachinePath, Mention, PluginLoader, Registration, Use
from ros_lint.facts.suppressions import SuppressionUse
from ros_lint.facts.visibility import ALL_FACETS, Facet, Opaque, Problem
from ros_lint.knowledge.providers import Suggestion
from ros_lint.knowledge.spelling import VENDOR, may_be_package, near_names
from ros_lint.workspace.build_scripts.resources import uninstalled_resources
from ros_lint.workspace.model import Declared, Package, Workspace, called, from_base, place_of, relative, top_file
from ros_lint.workspace.target import TargetDistro
from ros_lint.workspace.usage.resolve import satisfying, used_names
from ros_lint.workspace.usage.unused_find_package import generated_from
from ros_lint.workspace.usage.visibility import is_build_visible, is_fully_visible, is_traceless_by_name, name_suggests_no_trace

if TYPE_CHECKING:  # made only where it is asked for
    from ros_lint.collectors.launch.expand import Started as Started  # noqa: PLC0414

__all__ = [
    "ALL_FACETS",
    "ENDS",
    "EXPORTING_PLUGINS",
    "FINDS_TESTS",
    "HEADERS",
    "INTERFACES",
    "LAUNCH_FILE_NAMES",
    "LINTERS",
    "PYTHON_LIKE",
    "REGISTERING",
    "STANDARD_LIBRARY",
    "VENDOR",
    "BuildScript",
    "BuildTarget",
    "Call",
    "Component",
    "Confidence",
    "Cycle",
    "Declared",
    "Depend",
    "Edge",
    "Edit",
    "EditableList",
    "Element",
    "EntryPoint",
    "Facet",
    "FailingExpression",
    "Finding",
    "Fix",
    "Graph",
    "IncludeResolver",
    "IncludeTree",
    "InstalledFile",
    "InstalledPrograms",
    "LaunchAction",
    "LaunchCondition",
    "LaunchFile",
    "LaunchReference",
    "LaunchValue",
    "LostProvision",
    "MachinePath",
    "Manifest",
    "Mention",
    "Need",
    "NodeParameterFile",
    "Opaque",
    "Package",
    "PackageLaunchFile",
    "ParameterFiles",
    "PassedFile",
    "PlacedInclude",
    "PluginClass",
    "PluginFile",
    "PluginLibrary",
    "PluginLoader",
    "Problem",
    "PythonModule",
    "Reason",
    "Registration",
    "Related",
    "Remedy",
    "Role",
    "Rule",
    "ScopeLeaks",
    "ScriptFile",
    "Severity",
    "Span",
    "Suggestion",
    "SuppressionUse",
    "TargetDistro",
    "UninstalledImport",
    "UnresolvedDependency",
    "Use",
    "Workspace",
    "add_dependency",
    "are_consistent",
    "ask_if_meant",
    "assigned_configurations",
    "availability_remark",
    "cached_by_package",
    "cached_by_workspace",
    "called",
    "change_dependency",
    "cmake_edits",
    "conditions",
    "config_names",
    "configurations",
    "cycles",
    "declared_closure",
    "declared_names",
    "dependency_graph",
    "did_you_mean",
    "evaluated_name",
    "exists_in_any_distro",
    "expand_defaults",
    "failing_expressions",
    "file_start",
    "files_looked_up",
    "files_using_client_library",
    "find_package_closure",
    "finds_declared",
    "first_related",
    "folders_of",
    "from_base",
    "generated_from",
    "has_extras",
    "has_header",
    "has_programs",
    "include_resolver",
    "includes",
    "install_arguments",
    "installed_programs",
    "installed_targets",
    "installed_to_bin_only",
    "installs_built",
    "intended_names",
    "interface_names",
    "is_auxiliary",
    "is_build_visible",
    "is_declared_misspelled",
    "is_declared_shared",
    "is_excluded_from_install",
    "is_for_tests",
    "is_fully_visible",
    "is_launch_file",
    "is_library",
    "is_mostly_runtime",
    "is_node_renaming",
    "is_optional_target",
    "is_part_of_launch",
    "is_plain",
    "is_traceless_by_name",
    "is_unresolvable_key",
    "is_used_in_sources",
    "launch_suffix",
    "libraries_in_libexec",
    "library_calls",
    "library_registering",
    "macro_packages",
    "manifest_edits",
    "manifest_is_complete",
    "may_be_package",
    "may_be_used_without_trace",
    "may_provide",
    "may_run_built",
    "misspelled_names",
    "name_suggests_no_trace",
    "names_searched",
    "naming_fix",
    "near_names",
    "needed_transitively",
    "needs",
    "never_installed_nodes",
    "node_references",
    "node_targets",
    "nodes_started",
    "opaque_except_undefined_targets",
    "optional_needs",
    "package_launch_files",
    "partial_closure",
    "partly_installed_nodes",
    "passed_files",
    "place_of",
    "programs_built",
    "provided_in_other_distros",
    "provided_transitively",
    "read_sites",
    "references_by_name",
    "relative",
    "remedy",
    "remove_dependency",
    "rename_fix",
    "required_configurations",
    "resembles_ament_package",
    "satisfying",
    "setup_edits",
    "shorten_list",
    "similar_names",
    "stem",
    "stops_early",
    "substitute",
    "tag_for",
    "too_new",
    "top_file",
    "undeclared",
    "undeclared_match",
    "unguarded_tests",
    "uninstalled_resources",
    "unresolved",
    "unused_find_packages",
    "usage_is_visible",
    "used_files",
    "used_names",
    "values_of_action",
    "walk_actions",
]
