"""Verbs of colcon."""
