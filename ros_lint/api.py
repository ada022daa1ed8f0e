"""Everything a rule may import."""

from ros_lint import conditions, manifest_edits
from ros_lint.declare import add_dependency, builds_something, remove_dependency, tag_for, works_unseen
from ros_lint.facts import (
    ANYTHING,
    ROLES,
    BuildScript,
    Component,
    Depend,
    Element,
    EntryPoint,
    Facet,
    LaunchFile,
    LaunchReference,
    Manifest,
    Opaque,
    Problem,
    Provided,
    Role,
    Use,
)
from ros_lint.facts import Target as BuildTarget
from ros_lint.graph import Edge, Graph, Reason
from ros_lint.graph_cut import Knot, knots
from ros_lint.launch_files import Launchable, Programs, launchable, programs
from ros_lint.rule import Confidence, Edit, Finding, Fix, Related, Rule, Severity
from ros_lint.strangers import Stranger, declared_names
from ros_lint.suppress import Outcome
from ros_lint.text import Span
from ros_lint.workspace import Declared, Package, Target, Workspace
from ros_lint.world import Meant

__all__ = [
    "ANYTHING",
    "ROLES",
    "BuildScript",
    "BuildTarget",
    "Component",
    "Confidence",
    "Declared",
    "Depend",
    "Edge",
    "Edit",
    "Element",
    "EntryPoint",
    "Facet",
    "Finding",
    "Fix",
    "Graph",
    "Knot",
    "LaunchFile",
    "LaunchReference",
    "Launchable",
    "Manifest",
    "Meant",
    "Opaque",
    "Outcome",
    "Package",
    "Problem",
    "Programs",
    "Provided",
    "Reason",
    "Related",
    "Role",
    "Rule",
    "Severity",
    "Span",
    "Stranger",
    "Target",
    "Use",
    "Workspace",
    "add_dependency",
    "conditions",
    "builds_something",
    "declared_names",
    "knots",
    "launchable",
    "manifest_edits",
    "programs",
    "remove_dependency",
    "tag_for",
    "works_unseen",
]
