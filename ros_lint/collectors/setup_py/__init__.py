"""Evaluation and edits of setup.py and setup.cfg."""
