"""Refresh the data of the released world from rosdistro and rosdep."""
