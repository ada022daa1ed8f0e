"""The pytest plugin that registers the marker ``ros_lint``."""


def pytest_configure(config):
    """Register the marker."""
    config.addinivalue_line("markers", "ros_lint: marks tests that check a package with ros-lint")
