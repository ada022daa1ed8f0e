"""Evaluate the build scripts of packages, and collect the files that belong to them: plugin descriptions, programs, resources."""
