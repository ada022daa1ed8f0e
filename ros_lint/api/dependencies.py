"""Functions and types about dependencies: what a package needs, what it declares, and edits of its manifest."""

from ros_lint.analysis.dependencies.alternatives import standing_for_first
from ros_lint.analysis.dependencies.declared_closure import declared_closure, provided_transitively
from ros_lint.analysis.dependencies.find_package import (
    find_package_closure,
    finding_others,
    finds_declared,
    found_only_through,
    macro_packages,
    names_searched,
    partial_closure,
)
from ros_lint.analysis.dependencies.load_bearing import LostProvision, needed_transitively, unused_find_packages
from ros_lint.analysis.dependencies.misplaced import Misplaced, misplaced
from ros_lint.analysis.dependencies.needs import Need, is_found_by_cmake, needs, optional_needs
from ros_lint.analysis.dependencies.remedy import (
    Remedy,
    availability_remark,
    condition_for,
    condition_format,
    is_of_pip,
    is_unresolvable_key,
    naming_fix,
    remedy,
)
from ros_lint.analysis.dependencies.tags import (
    TEST_LIBRARIES,
    TEST_MODULES,
    TEST_TOOLS,
    add_dependency,
    change_dependency,
    remove_dependency,
    tag_for,
)
from ros_lint.analysis.dependencies.traceless import (
    PYTHON_LIKE,
    has_programs,
    is_library,
    is_metapackage,
    is_mostly_runtime,
    may_be_used_without_trace,
    usage_is_visible,
)
from ros_lint.analysis.dependencies.undeclared import (
    distros_providing,
    exists_in_any_distro,
    is_declared_misspelled,
    is_part_of_launch,
    manifest_is_complete,
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
    wrong_name_explains,
)
from ros_lint.collectors.manifest import conditions
from ros_lint.workspace.usage.resolve import satisfying, used_names
from ros_lint.workspace.usage.visibility import is_build_visible, is_fully_visible, is_traceless_by_name, name_suggests_no_trace

__all__ = [
    "PYTHON_LIKE",
    "TEST_LIBRARIES",
    "TEST_MODULES",
    "TEST_TOOLS",
    "LostProvision",
    "Misplaced",
    "Need",
    "Remedy",
    "UnresolvedDependency",
    "add_dependency",
    "availability_remark",
    "change_dependency",
    "condition_for",
    "condition_format",
    "conditions",
    "declared_closure",
    "declared_names",
    "distros_providing",
    "exists_in_any_distro",
    "find_package_closure",
    "finding_others",
    "finds_declared",
    "found_only_through",
    "has_programs",
    "intended_names",
    "is_build_visible",
    "is_declared_misspelled",
    "is_found_by_cmake",
    "is_fully_visible",
    "is_library",
    "is_metapackage",
    "is_mostly_runtime",
    "is_of_pip",
    "is_part_of_launch",
    "is_traceless_by_name",
    "is_unresolvable_key",
    "is_used_in_sources",
    "macro_packages",
    "manifest_is_complete",
    "may_be_used_without_trace",
    "may_provide",
    "misplaced",
    "misspelled_names",
    "name_suggests_no_trace",
    "names_searched",
    "naming_fix",
    "needed_transitively",
    "needs",
    "optional_needs",
    "partial_closure",
    "provided_transitively",
    "remedy",
    "remove_dependency",
    "resembles_ament_package",
    "satisfying",
    "standing_for_first",
    "tag_for",
    "undeclared",
    "undeclared_match",
    "unresolved",
    "unused_find_packages",
    "usage_is_visible",
    "used_names",
    "wrong_name_explains",
]
