"""Refresh the data about released packages from rosdistro and rosdep."""
