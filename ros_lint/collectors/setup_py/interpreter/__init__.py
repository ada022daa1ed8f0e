"""Interpreter of setup.py that executes nothing."""
