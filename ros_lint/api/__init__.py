"""Everything that a rule may import: the types of rules, findings and facts, and modules with functions."""

from ros_lint.analysis.finding import Confidence, Consequence, Finding, Fix, Related, Severity
from ros_lint.analysis.memo import cached_by_name, cached_by_package, cached_by_workspace
from ros_lint.analysis.rule import Rule
from ros_lint.analysis.wording import first_related
from ros_lint.api import build, dependencies, edits, files, graph, launch, manifests, names
from ros_lint.base.by_name import ByName
from ros_lint.base.edit import Edit
from ros_lint.base.text import Span
from ros_lint.collectors.python.versions import STANDARD_LIBRARY, too_new
from ros_lint.facts.build import (
    BuildExports,
    BuildFiles,
    BuildProducts,
    BuildProject,
    BuildScript,
    CMakeBuild,
    CMakeCommands,
    Component,
    ExportedTarget,
    InstalledFile,
    PluginClass,
    PluginFile,
    PluginLibrary,
    ScriptFile,
    SetupScript,
    UninstalledImport,
)
from ros_lint.facts.cmake import BuildTarget, Call, CommandPlace, UnsetVariable
from ros_lint.facts.launch import LaunchAction, LaunchCondition, LaunchFile, LaunchReference, LaunchValue
from ros_lint.facts.manifest import Depend, Element, Manifest, Role
from ros_lint.facts.setup_py import EditableList, EntryPoint, PythonModule
from ros_lint.facts.sources import MachinePath, Mention, PluginLoader, Registration, Use
from ros_lint.facts.suppressions import SuppressionUse
from ros_lint.facts.visibility import ALL_FACETS, Facet, Opaque, Problem
from ros_lint.knowledge.providers import Suggestion
from ros_lint.workspace.model import Declared, Package, Workspace
from ros_lint.workspace.target import TargetDistro

__all__ = [
    "ALL_FACETS",
    "STANDARD_LIBRARY",
    "BuildExports",
    "BuildFiles",
    "BuildProducts",
    "BuildProject",
    "BuildScript",
    "BuildTarget",
    "ByName",
    "CMakeBuild",
    "CMakeCommands",
    "Call",
    "CommandPlace",
    "Component",
    "Confidence",
    "Consequence",
    "Declared",
    "Depend",
    "Edit",
    "EditableList",
    "Element",
    "EntryPoint",
    "ExportedTarget",
    "Facet",
    "Finding",
    "Fix",
    "InstalledFile",
    "LaunchAction",
    "LaunchCondition",
    "LaunchFile",
    "LaunchReference",
    "LaunchValue",
    "MachinePath",
    "Manifest",
    "Mention",
    "Opaque",
    "Package",
    "PluginClass",
    "PluginFile",
    "PluginLibrary",
    "PluginLoader",
    "Problem",
    "PythonModule",
    "Registration",
    "Related",
    "Role",
    "Rule",
    "ScriptFile",
    "SetupScript",
    "Severity",
    "Span",
    "Suggestion",
    "SuppressionUse",
    "TargetDistro",
    "UninstalledImport",
    "UnsetVariable",
    "Use",
    "Workspace",
    "build",
    "cached_by_name",
    "cached_by_package",
    "cached_by_workspace",
    "dependencies",
    "edits",
    "files",
    "first_related",
    "graph",
    "launch",
    "manifests",
    "names",
    "too_new",
]
