"""setup.py and setup.cfg: evaluation and edits."""
