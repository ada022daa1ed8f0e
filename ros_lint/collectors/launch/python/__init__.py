"""Static analysis of launch files in Python: the classes and functions of the launch libraries."""
