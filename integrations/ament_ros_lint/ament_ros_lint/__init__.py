"""Checks of ROS 2 packages with ros-lint for ament."""
