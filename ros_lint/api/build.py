"""Functions and types about build scripts: what a package builds, what it installs and what it fails to install."""

from ros_lint.analysis.build.build_types import build_types
from ros_lint.analysis.build.commands import (
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
    unconditional_calls,
    unguarded_tests,
)
from ros_lint.analysis.build.entry_points import entry_point_target
from ros_lint.analysis.build.interfaces import GENERATING, interface_generation
from ros_lint.analysis.build.plugins import Plugins, plugin_loaders, plugins
from ros_lint.analysis.build.targets import (
    files_using_client_library,
    has_header,
    install_arguments,
    installed_to_bin_only,
    installs_built,
    is_declared_shared,
    is_optional_target,
    libraries_elsewhere,
    library_calls,
    library_registering,
    may_run_built,
    never_installed_nodes,
    node_targets,
    partly_installed_nodes,
    programs_built,
    stem,
)
from ros_lint.analysis.build.xmllint import runs_xmllint
from ros_lint.analysis.headers import EXPORTING_LIBRARIES, Includes, OwnHeaders, own_headers, related_includes
from ros_lint.facts.build import ENDS
from ros_lint.workspace.build_scripts.resources import uninstalled_resources
from ros_lint.workspace.usage.unused_find_package import generated_from

__all__ = [
    "ENDS",
    "EXPORTING_LIBRARIES",
    "EXPORTING_PLUGINS",
    "FINDS_TESTS",
    "GENERATING",
    "LINTERS",
    "REGISTERING",
    "Includes",
    "OwnHeaders",
    "Plugins",
    "build_types",
    "config_names",
    "entry_point_target",
    "evaluated_name",
    "files_using_client_library",
    "generated_from",
    "has_extras",
    "has_header",
    "install_arguments",
    "installed_targets",
    "installed_to_bin_only",
    "installs_built",
    "interface_generation",
    "is_declared_shared",
    "is_optional_target",
    "libraries_elsewhere",
    "library_calls",
    "library_registering",
    "may_run_built",
    "never_installed_nodes",
    "node_targets",
    "opaque_except_undefined_targets",
    "own_headers",
    "partly_installed_nodes",
    "plugin_loaders",
    "plugins",
    "programs_built",
    "related_includes",
    "runs_xmllint",
    "stem",
    "stops_early",
    "unconditional_calls",
    "unguarded_tests",
    "uninstalled_resources",
]
