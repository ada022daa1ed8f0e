"""Functions and types for the validation of manifests by the XML schema of their format."""

from ros_lint.analysis.manifest_schema import named_schema, violations
from ros_lint.collectors.manifest.schema.named import NamedSchema
from ros_lint.collectors.manifest.schema.validate import BAD_VALUE, MISPLACED, TEXT, Violation

__all__ = [
    "BAD_VALUE",
    "MISPLACED",
    "TEXT",
    "NamedSchema",
    "Violation",
    "named_schema",
    "violations",
]
