"""Python sources: imports, look-ups, names and syntax."""
