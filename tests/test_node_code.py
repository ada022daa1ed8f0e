"""Nodes and the parameters that they declare in C++ and Python code."""

from __future__ import annotations

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.cpp import nodes as cpp
from ros_lint.collectors.python import nodes as python


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ('declare_parameter<double>("a", 1)', ("a", "double")),
        ('this->declare_parameter("a", 1.0);', ("a", "double")),
        ('declare_parameter("a", 0.5f)', ("a", "double")),
        ('declare_parameter("a", 1e-3)', ("a", "double")),
        ('declare_parameter("a.b", -5)', ("a.b", "integer")),
        ('declare_parameter("a", true)', ("a", "bool")),
        ('declare_parameter("a", "x, y")', ("a", "string")),
        ('declare_parameter("a", std::string("x"))', ("a", "string")),
        ('declare_parameter<std::string>("a")', ("a", "string")),
        ('declare_parameter<std::vector<double>>("a", {})', ("a", "double_array")),
        ('declare_parameter("a", std::vector<std::string>{"x"})', ("a", "string_array")),
        ('declare_parameter("a", rclcpp::ParameterValue(5))', ("a", "integer")),
        ('declare_parameter("a", rclcpp::PARAMETER_DOUBLE)', ("a", "double")),
        ('declare_parameter("a", rclcpp::ParameterType::PARAMETER_INTEGER_ARRAY)', ("a", "integer_array")),
        ('nav2_util::declare_parameter_if_not_declared(node, "a", rclcpp::ParameterValue(0.5))', ("a", "double")),
        ('declare_parameter("a", 5 * factor)', ("a", "")),
        ('declare_parameter("a", value_)', ("a", "")),
        ('declare_parameter("a")', ("a", "")),
        ('declare_parameter(\n  "a",  // why\n  1.0)', ("a", "double")),
    ],
)
def test_declarations_in_cpp(call: str, expected: tuple[str, str]) -> None:
    code = cpp.node_code(Text("a.cpp", f"void f() {{ {call}; }}\n"))
    assert code is not None
    assert [(parameter.name, parameter.type) for parameter in code.declared] == [expected]
    assert code.complete


@pytest.mark.parametrize(
    "text",
    [
        "declare_parameter(name, 1);",
        'declare_parameter(prefix + ".a", 1);',
        'options.automatically_declare_parameters_from_overrides(true); declare_parameter("a", 1);',
        'options.allow_undeclared_parameters(true); declare_parameter("a", 1);',
    ],
)
def test_further_parameters_in_cpp(text: str) -> None:
    code = cpp.node_code(Text("a.cpp", text))
    assert code is not None
    assert not code.complete


def test_comments_and_dynamic_types_in_cpp() -> None:
    code = cpp.node_code(
        Text("a.cpp", '// declare_parameter("a", 1);\nd.dynamic_typing = true;\ndeclare_parameter("b", 1, d);\n')
    )
    assert code is not None
    assert [(parameter.name, parameter.type, parameter.span.line) for parameter in code.declared] == [("b", "", 3)]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ('A::A() : Node("a") {}', ("a",)),
        ('A::A(const O & o) : rclcpp_lifecycle::LifecycleNode("a", o) {}', ("a",)),
        ('auto node = std::make_shared<rclcpp::Node>("a");', ("a",)),
        ('auto node = rclcpp::Node::make_shared("a");', ("a",)),
        ('rclcpp::Node node{"a"};', ("a",)),
        ('Node("a"); Node("b");', ("a", "b")),
        ('tree.getNode("a"); // Node("b")', ()),
    ],
)
def test_names_of_nodes_in_cpp(text: str, names: tuple[str, ...]) -> None:
    code = cpp.node_code(Text("a.cpp", text))
    assert (code.names if code is not None else ()) == names


PYTHON = """import rclpy
class A(rclpy.node.Node):
    def __init__(self):
        super().__init__('a')
        self.declare_parameter('rate', 10.0)
        self.declare_parameter('count', -1)
        self.declare_parameter(name='frame', value='map')
        self.declare_parameter('names', ['x', 'y'])
        self.declare_parameter('kind', Parameter.Type.DOUBLE_ARRAY)
        self.declare_parameter('any')
        self.declare_parameter('computed', f())
        self.declare_parameters('', [('flag', True), ['gain', 1.5]])
        self.declare_parameters(namespace='arm', parameters=[('speed', 2)])
"""


def test_declarations_in_python() -> None:
    code = python.node_code(Text("a.py", PYTHON))
    assert code is not None
    assert code.names == ("a",)
    assert {parameter.name: parameter.type for parameter in code.declared} == {
        "rate": "double",
        "count": "integer",
        "frame": "string",
        "names": "string_array",
        "kind": "double_array",
        "any": "",
        "computed": "",
        "flag": "bool",
        "gain": "double",
        "arm.speed": "integer",
    }
    assert str(code.declared[0].span) == "a.py:5:32"
    assert code.complete


@pytest.mark.parametrize(
    "call",
    [
        "self.declare_parameter(name, 1)",
        "self.declare_parameters('', rows)",
        "self.declare_parameters('', [(n, 1) for n in names])",
        "super().__init__('a', automatically_declare_parameters_from_overrides=True)",
    ],
)
def test_further_parameters_in_python(call: str) -> None:
    code = python.node_code(Text("a.py", f"import rclpy\n{call}\n"))
    assert code is not None
    assert not code.complete


def test_code_without_nodes_has_no_facts() -> None:
    assert cpp.node_code(Text("a.cpp", 'int main() { return f("a"); }')) is None
    assert python.node_code(Text("a.py", "import os\nf('a')\n")) is None


@pytest.mark.parametrize(
    ("text", "topics"),
    [
        ('create_publisher<std_msgs::msg::String>("chatter", 10)', ("chatter",)),
        ('create_subscription<M>(\n  "~/in", rclcpp::QoS{1}, [](M::SharedPtr) {})', ("~/in",)),
        ('rclcpp_action::create_server<A>(this, "move", a, b, c)', ("move",)),
        ('sub_.subscribe(this, "scan", qos)', ("scan",)),
        ("create_publisher<M>(topic_, 10)", None),
        ('create_publisher<M>(prefix + "/out", 10)', None),
        ('create_publisher<M>("out" + suffix, 10)', None),
    ],
)
def test_topics_in_cpp(text: str, topics: tuple[str, ...] | None) -> None:
    code = cpp.node_code(Text("a.cpp", f"{text};\n"))
    assert code is not None
    assert code.topics == topics


@pytest.mark.parametrize(
    ("text", "topics"),
    [
        ("self.create_publisher(String, 'chatter', 10)", ("chatter",)),
        ("self.create_subscription(String, topic='chatter', callback=f, qos_profile=10)", ("chatter",)),
        ("ActionClient(self, Move, 'move')", ("move",)),
        ("self.create_service(Trigger, self.name, f)", None),
    ],
)
def test_topics_in_python(text: str, topics: tuple[str, ...] | None) -> None:
    code = python.node_code(Text("a.py", f"import rclpy\n{text}\n"))
    assert code is not None
    assert code.topics == topics
