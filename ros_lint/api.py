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
    hidden,
    installed_targets,
    is_cut_short,
    unguarded_tests,
)
from ros_lint.analysis.build.targets import (
    astray,
    forgotten_nodes,
    has_header,
    installs_built,
    is_on_request,
    is_shared_by_words,
    left_out_nodes,
    library_calls,
    library_of,
    listed_to_install,
    may_run_built,
    node_targets,
    programs_built,
    stem,
    stranded,
    with_client,
)
from ros_lint.analysis.dependencies.declared_closure import covered, declared_closure
from ros_lint.analysis.dependencies.find_package import come_along, finds_declared, found_along, found_names, given_for
from ros_lint.analysis.dependencies.load_bearing import Carried, carriers, found_for_nothing
from ros_lint.analysis.dependencies.needs import Need, needs, wishes
from ros_lint.analysis.dependencies.remedy import Advice, advice, availability, lacks_rule, naming
from ros_lint.analysis.dependencies.tags import add_dependency, change_dependency, remove_dependency, tag_for
from ros_lint.analysis.dependencies.traceless import PYTHON_LIKE, is_library, is_mostly_run, leaves_trace, runs, works_unseen
from ros_lint.analysis.dependencies.undeclared import (
    comes_elsewhere,
    comes_with_launching,
    is_miswritten,
    is_somewhere,
    tells,
    undeclared,
)
from ros_lint.analysis.dependencies.unknown_closure import may_bring
from ros_lint.analysis.dependencies.unresolved import (
    Stranger,
    declared_names,
    is_named,
    is_near_tool,
    meant,
    misspelt,
    strangers,
    used_instead,
)
from ros_lint.analysis.finding import Confidence, Finding, Fix, Related, Severity
from ros_lint.analysis.graph.cycles import Knot, knots
from ros_lint.analysis.graph.dependency_graph import Edge, Graph, Reason, dependency_graph
from ros_lint.analysis.launch.configurations import Families, asked_at, needed
from ros_lint.analysis.launch.files import (
    Launchable,
    Programs,
    corrected,
    files_looked_up,
    is_kept_back,
    is_launched,
    launch_suffix,
    launchable,
    nodes_started,
    programs,
    referred,
    started,
    used_files,
)
from ros_lint.analysis.launch.includes import Links, defaults_of, filled, include_resolver
from ros_lint.analysis.launch.parameter_files import Given, ParameterFiles
from ros_lint.analysis.launch.runs import Broken, PassedFile, broken_expressions, launched, passed_files
from ros_lint.analysis.launch.scopes import Include, Left, includes
from ros_lint.analysis.memo import per_package, per_workspace
from ros_lint.analysis.rule import Rule
from ros_lint.analysis.wording import several
from ros_lint.base.auxiliary_files import is_apart, is_for_tests
from ros_lint.base.edit import Edit
from ros_lint.base.paths import folders_of
from ros_lint.base.suggestions import did_you_mean, few, is_meant, similar
from ros_lint.base.text import Span, beginning
from ros_lint.collectors.interfaces import naming as interface_names
from ros_lint.collectors.launch.detect import NAMES as LAUNCH_NAMES
from ros_lint.collectors.manifest import conditions
from ros_lint.collectors.manifest import edits as manifest_edits
from ros_lint.collectors.python.versions import STANDARD_LIBRARY, too_new
from ros_lint.collectors.setup_py import edits as setup_edits
from ros_lint.collectors.suffixes import HEADERS, INTERFACES
from ros_lint.collectors.symbolic_text import agree, configurations, is_plain, renames
from ros_lint.facts.build import BuildScript, Component, LeftBehind, PluginClass, PluginFile, PluginLibrary, Provided, ScriptFile
from ros_lint.facts.cmake import Call
from ros_lint.facts.cmake import Target as BuildTarget
from ros_lint.facts.launch import LaunchAction, LaunchCondition, LaunchFile, LaunchReference, LaunchValue, everything, texts_of
from ros_lint.facts.manifest import Depend, Element, Manifest, Role
from ros_lint.facts.setup_py import EntryPoint, PythonModule, Slot
from ros_lint.facts.sources import MachinePath, Mention, PluginLoader, Registration, Use
from ros_lint.facts.suppressions import SuppressionUse
from ros_lint.facts.visibility import ANYTHING, Facet, Opaque, Problem
from ros_lint.knowledge.providers import Meant
from ros_lint.knowledge.spelling import VENDOR, may_be_package, near_names
from ros_lint.workspace.build_scripts.resources import uninstalled as uninstalled_resources
from ros_lint.workspace.model import Declared, Package, Workspace, called, from_base, place_of, relative, top_file
from ros_lint.workspace.target import Target
from ros_lint.workspace.usage.resolve import satisfying, used_names
from ros_lint.workspace.usage.unused_find_package import generated_from
from ros_lint.workspace.usage.visibility import is_built_in_sight, is_seen_whole, is_unseen_by_name, sounds_unseen

if TYPE_CHECKING:  # made only where it is asked for
    from ros_lint.collectors.launch.expand import Started as Started  # noqa: PLC0414

__all__ = [
    "ANYTHING",
    "ENDS",
    "EXPORTING_PLUGINS",
    "FINDS_TESTS",
    "HEADERS",
    "INTERFACES",
    "LAUNCH_NAMES",
    "LINTERS",
    "PYTHON_LIKE",
    "REGISTERING",
    "STANDARD_LIBRARY",
    "VENDOR",
    "Advice",
    "Broken",
    "BuildScript",
    "BuildTarget",
    "Call",
    "Carried",
    "Component",
    "Confidence",
    "Declared",
    "Depend",
    "Edge",
    "Edit",
    "Element",
    "EntryPoint",
    "Facet",
    "Families",
    "Finding",
    "Fix",
    "Given",
    "Graph",
    "Include",
    "Knot",
    "LaunchAction",
    "LaunchCondition",
    "LaunchFile",
    "LaunchReference",
    "LaunchValue",
    "Launchable",
    "Left",
    "LeftBehind",
    "Links",
    "MachinePath",
    "Manifest",
    "Meant",
    "Mention",
    "Need",
    "Opaque",
    "Package",
    "ParameterFiles",
    "PassedFile",
    "PluginClass",
    "PluginFile",
    "PluginLibrary",
    "PluginLoader",
    "Problem",
    "Programs",
    "Provided",
    "PythonModule",
    "Reason",
    "Registration",
    "Related",
    "Role",
    "Rule",
    "ScriptFile",
    "Severity",
    "Slot",
    "Span",
    "Stranger",
    "SuppressionUse",
    "Target",
    "Use",
    "Workspace",
    "add_dependency",
    "advice",
    "agree",
    "asked_at",
    "astray",
    "availability",
    "beginning",
    "broken_expressions",
    "called",
    "carriers",
    "change_dependency",
    "cmake_edits",
    "come_along",
    "comes_elsewhere",
    "comes_with_launching",
    "conditions",
    "config_names",
    "configurations",
    "corrected",
    "covered",
    "declared_closure",
    "declared_names",
    "defaults_of",
    "dependency_graph",
    "did_you_mean",
    "evaluated_name",
    "everything",
    "few",
    "files_looked_up",
    "filled",
    "finds_declared",
    "folders_of",
    "forgotten_nodes",
    "found_along",
    "found_for_nothing",
    "found_names",
    "from_base",
    "generated_from",
    "given_for",
    "has_extras",
    "has_header",
    "hidden",
    "include_resolver",
    "includes",
    "installed_targets",
    "installs_built",
    "interface_names",
    "is_apart",
    "is_built_in_sight",
    "is_cut_short",
    "is_for_tests",
    "is_kept_back",
    "is_launched",
    "is_library",
    "is_meant",
    "is_miswritten",
    "is_mostly_run",
    "is_named",
    "is_near_tool",
    "is_on_request",
    "is_plain",
    "is_seen_whole",
    "is_shared_by_words",
    "is_somewhere",
    "is_unseen_by_name",
    "knots",
    "lacks_rule",
    "launch_suffix",
    "launchable",
    "launched",
    "leaves_trace",
    "left_out_nodes",
    "library_calls",
    "library_of",
    "listed_to_install",
    "manifest_edits",
    "may_be_package",
    "may_bring",
    "may_run_built",
    "meant",
    "misspelt",
    "naming",
    "near_names",
    "needed",
    "needs",
    "node_targets",
    "nodes_started",
    "passed_files",
    "per_package",
    "per_workspace",
    "place_of",
    "programs",
    "programs_built",
    "referred",
    "relative",
    "remove_dependency",
    "renames",
    "runs",
    "satisfying",
    "setup_edits",
    "several",
    "similar",
    "sounds_unseen",
    "started",
    "stem",
    "stranded",
    "strangers",
    "tag_for",
    "tells",
    "texts_of",
    "too_new",
    "top_file",
    "undeclared",
    "unguarded_tests",
    "uninstalled_resources",
    "used_files",
    "used_instead",
    "used_names",
    "wishes",
    "with_client",
    "works_unseen",
]
