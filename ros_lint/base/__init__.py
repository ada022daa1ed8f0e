"""Modules that are independent of ROS: texts, places in files, file trees, paths, graphs and parsers."""
