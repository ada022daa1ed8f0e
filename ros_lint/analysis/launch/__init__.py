"""Analyses of launch files for rules: includes, configurations, and the programs that launch files start."""
