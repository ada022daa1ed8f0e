"""The validation of a package.xml by the XML schema of its format."""

from __future__ import annotations

from ros_lint.base.text import Text
from ros_lint.collectors.manifest.schema import named, validate
from ros_lint.facts.manifest import Manifest


def violations(manifest: Manifest) -> tuple[validate.Violation, ...]:
    """Return the violations of a package.xml against the schema of its format. catkin_pkg has to accept the package.xml."""
    return validate.violations(_source(manifest), manifest.format) or ()


def named_schema(manifest: Manifest) -> named.NamedSchema | None:
    """Return the published schema that a package.xml names for ament_xmllint, None if it names no published schema."""
    return named.named_schema(_source(manifest))


def _source(manifest: Manifest) -> Text:
    return Text(manifest.path, manifest.text, manifest.codec)
