"""Everything a rule may import."""

from typing import TYPE_CHECKING

from ros_lint import cmake_edits, conditions, manifest_edits, setup_edits
from ros_lint.advice import Advice, advice, lacks_rule
from ros_lint.apart import is_apart, is_for_tests
from ros_lint.build_scripts import (
    ENDS,
    EXPORTING_PLUGINS,
    REGISTERING,
    astray,
    called,
    evaluated_name,
    forgotten_nodes,
    from_base,
    has_header,
    hidden,
    installed_targets,
    installs_built,
    is_on_request,
    is_shared_by_words,
    left_out_nodes,
    library_calls,
    library_of,
    listed_to_install,
    may_run_built,
    node_targets,
    place_of,
    programs_built,
    relative,
    stem,
    stranded,
    top_file,
    unguarded_tests,
    with_client,
)
from ros_lint.carriers import Carried, carriers, found_for_nothing
from ros_lint.cmake_finds import come_along, found_along, found_names, given_for
from ros_lint.collectors.launch import NAMES as LAUNCH_NAMES
from ros_lint.collectors.launch_text import agree, configurations, is_plain, renames
from ros_lint.declare import (
    PYTHON_LIKE,
    add_dependency,
    change_dependency,
    is_built_in_sight,
    is_library,
    is_mostly_run,
    is_seen_whole,
    is_unseen_by_name,
    leaves_trace,
    remove_dependency,
    tag_for,
    works_unseen,
)
from ros_lint.evidence import satisfying, used_names
from ros_lint.facts.build import BuildScript, Component, LeftBehind, PluginClass, PluginFile, PluginLibrary, Provided, ScriptFile
from ros_lint.facts.cmake import Call
from ros_lint.facts.cmake import Target as BuildTarget
from ros_lint.facts.launch import LaunchAction, LaunchCondition, LaunchFile, LaunchReference, LaunchValue
from ros_lint.facts.manifest import Depend, Element, Manifest, Role
from ros_lint.facts.setup_py import EntryPoint, PythonModule, Slot
from ros_lint.facts.sight import ANYTHING, Facet, Opaque, Problem
from ros_lint.facts.sources import MachinePath, Mention, PluginLoader, Registration, Use
from ros_lint.graph import Edge, Graph, Reason
from ros_lint.graph_cut import Knot, knots
from ros_lint.knowledge.spelling import may_be_package, near_names
from ros_lint.launch_files import Launchable, Programs, corrected, launchable, programs, referred
from ros_lint.launch_links import Links, defaults_of, everything, filled, texts_of
from ros_lint.launch_names import Families, needed
from ros_lint.launch_parameters import Given, ParameterFiles
from ros_lint.launch_runs import Broken, PassedFile, broken_expressions, launched, passed_files
from ros_lint.liveness import HEADERS
from ros_lint.needs import (
    Need,
    comes_elsewhere,
    comes_with_launching,
    covered,
    declared_closure,
    is_somewhere,
    needs,
    tells,
    undeclared,
    wishes,
)
from ros_lint.providers import Meant
from ros_lint.report import Target
from ros_lint.resource_files import uninstalled as uninstalled_resources
from ros_lint.rule import Confidence, Edit, Finding, Fix, Related, Rule, Severity
from ros_lint.slips import did_you_mean, similar
from ros_lint.strangers import Stranger, declared_names, is_near_tool, meant, strangers
from ros_lint.suppress import Outcome
from ros_lint.text import Span, beginning
from ros_lint.tree import folders_of
from ros_lint.unknowns import may_bring
from ros_lint.wording import few, several
from ros_lint.workspace import Declared, Package, Workspace, per_package, per_workspace

if TYPE_CHECKING:  # made only where it is asked for
    from ros_lint.interpret.launch_expand import Started as Started  # noqa: PLC0414

__all__ = [
    "ANYTHING",
    "ENDS",
    "EXPORTING_PLUGINS",
    "HEADERS",
    "LAUNCH_NAMES",
    "PYTHON_LIKE",
    "REGISTERING",
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
    "Knot",
    "LaunchAction",
    "LaunchCondition",
    "LaunchFile",
    "LaunchReference",
    "LaunchValue",
    "Launchable",
    "LeftBehind",
    "Links",
    "MachinePath",
    "Manifest",
    "Meant",
    "Mention",
    "Need",
    "Opaque",
    "Outcome",
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
    "Target",
    "Use",
    "Workspace",
    "add_dependency",
    "advice",
    "agree",
    "astray",
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
    "configurations",
    "corrected",
    "covered",
    "declared_closure",
    "declared_names",
    "defaults_of",
    "did_you_mean",
    "evaluated_name",
    "everything",
    "few",
    "filled",
    "folders_of",
    "forgotten_nodes",
    "found_along",
    "found_for_nothing",
    "found_names",
    "from_base",
    "given_for",
    "has_header",
    "hidden",
    "installed_targets",
    "installs_built",
    "is_apart",
    "is_built_in_sight",
    "is_for_tests",
    "is_library",
    "is_mostly_run",
    "is_near_tool",
    "is_on_request",
    "is_plain",
    "is_seen_whole",
    "is_shared_by_words",
    "is_somewhere",
    "is_unseen_by_name",
    "knots",
    "lacks_rule",
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
    "near_names",
    "needed",
    "needs",
    "node_targets",
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
    "satisfying",
    "setup_edits",
    "several",
    "similar",
    "stem",
    "stranded",
    "strangers",
    "tag_for",
    "tells",
    "texts_of",
    "top_file",
    "undeclared",
    "unguarded_tests",
    "uninstalled_resources",
    "used_names",
    "wishes",
    "with_client",
    "works_unseen",
]
