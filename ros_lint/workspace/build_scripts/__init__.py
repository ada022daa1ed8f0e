"""Evaluate the build scripts of packages, and the files that belong to them."""
