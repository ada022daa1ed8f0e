"""Types of other packages that stand in C++ code by their bare names."""

import pytest

from ros_lint.base.text import Span
from ros_lint.base.tree import MemoryTree
from ros_lint.collectors.cpp.types import declared, introduced
from ros_lint.facts.sources import FileFacts, Mention
from ros_lint.workspace.usage.package_files import PackageSource
from ros_lint.workspace.usage.unqualified_types import Types

ROUTE = b"namespace house::route_handler {\nclass HOUSE_PUBLIC RouteHandler : Base {};\nstruct Node\n{};\nclass Other;\n}\n"
DATA = b"using nav_msgs::msg::Odometry;\nusing Line = nav_msgs::msg::Path;\n"


def test_what_is_declared() -> None:
    assert declared(ROUTE) == {b"RouteHandler", b"Node"}
    assert declared(b"enum class Mode : int { A };\nenum Kind { B };\nstruct Point final { };") == {
        b"Mode",
        b"Kind",
        b"Point",
    }


def test_what_is_introduced() -> None:
    assert introduced(DATA) == {"nav_msgs": {b"Odometry", b"Line"}}


def source(name: str, files: dict[str, bytes], mentions: tuple[str, ...] = ()) -> PackageSource:
    found = tuple(Mention(each, "include", Span("f", 1, 1, 1, 2)) for each in mentions)
    facts = {file: FileFacts(found) for file in files}
    return PackageSource(name, name, tuple(files), None, facts, (), "ament_cmake")


def places(code: bytes) -> dict[str, tuple[int, int]]:
    files = {
        "house_route_handler": {"include/house/route_handler.hpp": ROUTE},
        "common": {"include/common/data.hpp": DATA},
        "node": {"src/node.cpp": code},
    }
    sources = {name: source(name, of, ("nav_msgs/msg/path.hpp",) if name == "common" else ()) for name, of in files.items()}
    texts = {f"{name}/{file}": text for name, of in files.items() for file, text in of.items()}
    types = Types(list(sources.values()), MemoryTree(texts), lambda name: set(files) if name == "node" else set())
    found = types.used(sources["node"], ["house_route_handler", "nav_msgs", "sensor_msgs"])
    assert all(span.path == "node/src/node.cpp" for span in found.values())
    return {name: span[1:3] for name, span in found.items()}


@pytest.mark.parametrize(
    ("code", "found"),
    [
        (b"\nauto x = std::make_shared<route_handler::RouteHandler>();", {"house_route_handler": (2, 42)}),
        (b"RouteHandler route;", {"house_route_handler": (1, 1)}),
        (b"route_handler::load();", {"house_route_handler": (1, 1)}),
        (b"class My : public rclcpp::Node { My() : Node(1) {} };", {}),
        (b'// a RouteHandler\nauto name = "RouteHandler"; /* Node */ a.Node();', {}),
        (b"struct Node { };\nNode node;", {}),
        (b"void on(const Odometry & odometry);", {"nav_msgs": (1, 15)}),
        (b"void on(const other::Odometry & odometry);\nLine line;", {"nav_msgs": (2, 1)}),
        (b"using Line = int;\nLine line;", {}),
    ],
)
def test_where_they_are_used(code: bytes, found: dict[str, tuple[int, int]]) -> None:
    assert places(code) == found
