"""Launch files in Python: what the classes and functions of the launch libraries mean."""
