import gc
from itertools import count

import pytest
from hypothesis import settings

# How long an example takes says nothing on a busy machine.
settings.register_profile("here", deadline=None)
settings.load_profile("here")

_NUMBERS = count()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--bless", action="store_true", help="rewrite expected output from what the tool does now")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("bless") and hasattr(config, "workerinput"):
        raise pytest.UsageError("--bless rewrites files that several cases share: without -n")


def pytest_collection_finish() -> None:
    """Search for cyclic garbage seldom, and not in the collected tests: it took a fifth of the time."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark property tests as slow: they run hundreds of examples."""
    for item in items:
        if getattr(getattr(item, "obj", None), "is_hypothesis_test", False):
            item.add_marker(pytest.mark.slow)


@pytest.fixture(autouse=True)
def _no_ros_around(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    """The caller's ROS, colours and caches are no part of any test."""
    for name in (
        "ROS_DISTRO",
        "AMENT_PREFIX_PATH",
        "COLCON_PREFIX_PATH",
        "CMAKE_PREFIX_PATH",
        "NO_COLOR",
        "FORCE_COLOR",
        "CLICOLOR_FORCE",
    ):
        monkeypatch.delenv(name, raising=False)
    home = tmp_path_factory.getbasetemp() / "home"
    home.mkdir(exist_ok=True)
    for name in ("XDG_CACHE_HOME", "XDG_CONFIG_HOME"):
        monkeypatch.setenv(name, str(home / name.lower()))
    # An index that a test refreshes is no data of the next one.
    monkeypatch.setenv("XDG_DATA_HOME", str(home / f"data-{next(_NUMBERS)}"))
