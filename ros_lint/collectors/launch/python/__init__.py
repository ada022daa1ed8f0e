"""Launch files in Python: the classes and functions of the launch libraries."""
