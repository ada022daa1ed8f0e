"""package.xml: reading, conditions, problems and edits."""
