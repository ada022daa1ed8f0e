"""Texts, spans, trees, paths and graphs: everything that is independent of ROS."""
