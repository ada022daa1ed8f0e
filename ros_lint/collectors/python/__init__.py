"""Python sources: imports, look-ups of packages, names and syntax."""
