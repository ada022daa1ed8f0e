"""Analyses of dependencies for rules: what a package needs, declares and provides transitively."""
