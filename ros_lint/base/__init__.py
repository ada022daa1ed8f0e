"""Texts, spans, trees, paths and graphs: everything that knows nothing of ROS."""
