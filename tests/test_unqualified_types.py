"""Types of other packages that C++ code uses by unqualified names."""

import pytest

from ros_lint.base.text import Span
from ros_lint.base.tree import MemoryTree
from ros_lint.collectors.cpp.types import declared_types, interface_aliases
from ros_lint.facts.sources import FileFacts, Mention
from ros_lint.workspace.usage.package_files import PackageSource
from ros_lint.workspace.usage.unqualified_types import Types

ROUTE = b"namespace house::route_handler {\nclass HOUSE_PUBLIC RouteHandler : Base {};\nstruct Node\n{};\nclass Other;\n}\n"
DATA = b"using nav_msgs::msg::Odometry;\nusing Line = nav_msgs::msg::Path;\n"


def test_declared_types_are_found() -> None:
    assert declared_types(ROUTE) == {b"RouteHandler", b"Node"}
    assert declared_types(b"enum class Mode : int { A };\nenum Kind { B };\nstruct Point final { };") == {
        b"Mode",
        b"Kind",
        b"Point",
    }


def test_aliases_of_interface_types_are_found() -> None:
    assert interface_aliases(DATA) == {"nav_msgs": {b"Odometry", b"Line"}}


def source(name: str, files: dict[str, bytes], mentions: tuple[str, ...] = ()) -> PackageSource:
    included = tuple(Mention(file, "include", Span("f", 1, 1, 1, 2)) for file in mentions)
    facts = {file: FileFacts(included) for file in files}
    return PackageSource(name, name, tuple(files), None, facts, (), "ament_cmake")


def places(code: bytes) -> dict[str, tuple[int, int]]:
    files = {
        "house_route_handler": {"include/house/route_handler.hpp": ROUTE},
        "common": {"include/common/data.hpp": DATA},
        "node": {"src/node.cpp": code},
    }
    sources = {name: source(name, of, ("nav_msgs/msg/path.hpp",) if name == "common" else ()) for name, of in files.items()}
    texts = {f"{name}/{file}": text for name, of in files.items() for file, text in of.items()}
    types = Types(MemoryTree(texts), lambda name: set(files) if name == "node" else set())
    types.renew(list(sources.values()))
    result = types.used(sources["node"], ["house_route_handler", "nav_msgs", "sensor_msgs"])
    assert all(span.path == "node/src/node.cpp" for span in result.values())
    return {name: span[1:3] for name, span in result.items()}


@pytest.mark.parametrize(
    ("code", "expected"),
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
def test_unqualified_uses_are_found(code: bytes, expected: dict[str, tuple[int, int]]) -> None:
    assert places(code) == expected
