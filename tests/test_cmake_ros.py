"""Macros of ROS packages, released and in the workspace."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.evaluate import evaluate
from ros_lint.collectors.cmake.evaluator.flow import HANDLERS
from ros_lint.collectors.cmake.evaluator.sources import Helper, Sources
from ros_lint.collectors.cmake.released_macros import macros
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.facts.visibility import ALL_FACETS, Facet
from tests.cmake_runs import HEAD, hidden, mentioned, paths, run, sources


def test_macros_mention_the_package_that_defines_them() -> None:
    script = run("if(BUILD_TESTING)\n  ament_add_gtest(t test/t.cpp)\nendif()\nament_package()\n", ("test/t.cpp",))
    mention = mentioned(script)[("macro", "ament_cmake_gtest")]
    assert (mention.what, mention.test, mention.span.line, mention.span.column) == ("ament_add_gtest()", True, 4, 3)
    assert [(target.name, target.sources, target.test) for target in script.products.targets] == [("t", ("test/t.cpp",), True)]
    assert {"ament_add_gtest", "ament_package"} <= set(script.commands.names)


def test_install_rules_are_inserted_before_ament_package() -> None:
    script = run("\n  ament_package()\n")
    assert str(script.commands.insertion) == "src/pkg/CMakeLists.txt:4:3"
    assert run("if(UNHEARD_OF)\nelse()\nament_package()\nendif()").commands.insertion is not None
    assert run("").commands.insertion is None


def test_ament_auto_builds_and_installs_by_convention() -> None:
    script = run(
        "find_package(ament_cmake_auto REQUIRED)\nament_auto_find_build_dependencies()\n"
        "ament_auto_add_library(core SHARED src/core.cpp)\nament_auto_add_executable(talker DIRECTORY src)\n"
        'rclcpp_components_register_node(core PLUGIN "ns::Node" EXECUTABLE node)\n'
        "ament_auto_package(INSTALL_TO_SHARE launch)\n",
        ("src/core.cpp", "src/main.cpp", "launch/a.launch.py", "include/pkg/core.hpp"),
        build_depends=("rclcpp",),
    )
    assert not script.opaque
    assert paths(script).keys() >= {
        "include/pkg/core.hpp", "lib/libcore.so", "lib/pkg/talker", "lib/pkg/node", "share/pkg/launch/a.launch.py",
        "share/pkg/package.xml", "share/ament_index/resource_index/packages/pkg",
    }  # fmt: skip
    assert [(component.name, component.span.line) for component in script.products.components] == [("ns::Node", 7)]
    assert {target.name: target.sources for target in script.products.targets} == {
        "core": ("src/core.cpp",), "talker": ("src/core.cpp", "src/main.cpp"), "node": (),
    }  # fmt: skip
    assert {provided.path: provided.span.line for provided in script.products.installs}["lib/pkg/node"] == 7


def test_macros_that_build_and_install_nothing_hide_nothing() -> None:
    script = run("ecl_enable_cxx14_compiler()\ninitialize_code_coverage()\nadd_run_tests_target(ENABLE ON)\n")
    assert not script.opaque
    assert {("macro", "ecl_build"), ("macro", "ros_industrial_cmake_boilerplate")} <= mentioned(script).keys()
    condition = "if(ECL_PLATFORM_HAS_POSIX_THREADS)\nadd_library(a a.cpp)\nendif()"
    detected = run(f"ecl_detect_threads()\necl_detect_filesystem()\n{condition}")
    assert [target.name for target in detected.products.targets] == ["a"]
    assert not detected.opaque


def test_interfaces_are_generated_and_installed() -> None:
    script = run(
        'set(msgs "msg/A.msg" "msg/B.msg")\n'
        'rosidl_generate_interfaces(${PROJECT_NAME} ${msgs} "srv/C.srv" DEPENDENCIES std_msgs)\n',
        ("msg/A.msg", "msg/B.msg", "srv/C.srv"),
    )
    assert script.products.interfaces == ("msg/A", "msg/B", "srv/C")
    assert script.products.python_packages == ("pkg",)
    assert {"share/pkg/msg/A.msg", "share/pkg/msg/A.idl", "share/pkg/srv/C.srv"} <= paths(script).keys()
    assert mentioned(script)[("target", "std_msgs")].purpose == "interfaces"
    assert mentioned(script)[("macro", "rosidl_default_generators")].purpose == "interfaces"


def test_interfaces_belong_to_the_project_that_generates_them() -> None:
    subproject = {
        "inner/CMakeLists.txt": "project(inner_msgs)\nrosidl_generate_interfaces(inner_msgs msg/A.msg)\n",
        "inner/msg/A.msg": "",
    }
    script = run("add_subdirectory(inner)\nrosidl_generate_interfaces(pkg msg/B.msg)\n", {**subproject, "msg/B.msg": ""})
    assert {path for path in paths(script) if path.endswith(".msg")} == {"share/inner_msgs/msg/A.msg", "share/pkg/msg/B.msg"}
    assert script.products.python_packages == ("inner_msgs", "pkg")


def test_definitions_keep_their_folder_and_generated_files_use_their_kind() -> None:
    script = run(
        "rosidl_generate_interfaces(pkg msg/base/A.msg srvs/B.srv msg/deep/C.idl)\n",
        ("msg/base/A.msg", "srvs/B.srv", "msg/deep/C.idl"),
    )
    assert {path.removeprefix("share/pkg/") for path in paths(script) if path.startswith("share/")} == {
        "base/A.msg", "msg/A.idl", "srvs/B.srv", "srv/B.idl", "msg/deep/C.idl",
    }  # fmt: skip


def test_generate_parameter_library_installs_headers() -> None:
    script = run(
        "generate_parameter_library(gains src/gains.yaml)\ngenerate_parameter_library(limits l.yaml src/check.hpp)\n",
        ("src/check.hpp",),
    )
    assert [path for path in paths(script) if path.startswith("include/")] == [
        "include/pkg/gains.hpp", "include/pkg/limits.hpp", "include/pkg/check.hpp",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("", {"cmake/vendor_package_cmake_prefix.cmake", "environment/vendor_package.sh"}),
        ("GLOBAL_HOOK", {"environment/vendor_package.sh", "environment/vendor_package_cmake_prefix.sh"}),
        ("SKIP_INSTALL", set()),
        ("SATISFIED TRUE", set()),
    ],
)
def test_ament_vendor_installs_its_environment_hooks(words: str, expected: set[str]) -> None:
    script = run(f"ament_vendor(other VCS_URL https://example.org/other.git {words})\n")
    installed = {path.removeprefix("share/pkg/") for path in paths(script) if path.endswith((".sh", ".cmake"))}
    assert installed == expected
    assert ("share/ament_index/resource_index/vendor_packages/pkg" in paths(script)) == bool(expected)


def test_ament_python_install_package_installs_modules_and_programs() -> None:
    files = ("pkg_py/__init__.py", "pkg_py/sub/__init__.py", "pkg_py/sub/x.py", "setup.cfg")
    texts = {"setup.cfg": "[options.entry_points]\nconsole_scripts =\n    tool = pkg_py.sub.x:main\n"}
    text = "ament_python_install_package(pkg_py SCRIPTS_DESTINATION lib/${PROJECT_NAME})\n"
    script = run(text, files, texts=texts)
    assert script.products.python_packages == ("pkg_py", "pkg_py.sub")
    assert paths(script).keys() >= {"lib/python/site-packages/pkg_py/sub/x.py", "lib/pkg/tool"}
    assert not script.opaque
    assert hidden(run(text, files)) == Facet.EXECUTABLES


def test_plugins_use_the_package_of_their_base_class() -> None:
    script = run("pluginlib_export_plugin_description_file(nav2_core plugins.xml)\n", ("plugins.xml",))
    assert paths(script).keys() >= {"share/pkg/plugins.xml"}
    loader = mentioned(script)[("target", "nav2_core")]
    assert (loader.what, loader.purpose) == ("pluginlib_export_plugin_description_file(nav2_core)", "plugins")


def helper(name: str, files: Mapping[str, str], script: str) -> Helper:
    parsed = {path: parse(Text(f"src/{name}/{path}", text)) for path, text in {"CMakeLists.txt": script, **files}.items()}
    package = Sources(name, f"src/{name}", sorted(parsed), parsed)
    return Helper(package, evaluate(package))


@pytest.mark.parametrize("name", ["tools", "@PROJECT_NAME@"])
def test_macros_of_the_workspace_are_evaluated(name: str) -> None:
    tools = helper(
        "tools",
        {
            "cmake/tools-extras.cmake.in": f'include("${{{name}_DIR}}/install_all.cmake")\nfind_package(rclcpp REQUIRED)\n',
            "cmake/install_all.cmake": "macro(install_all)\n"
            "install(DIRECTORY ${ARGN} DESTINATION share/${PROJECT_NAME})\nendmacro()\n",
        },
        "project(tools)\ninstall(FILES cmake/install_all.cmake DESTINATION share/tools/cmake)\n"
        "ament_package(CONFIG_EXTRAS cmake/tools-extras.cmake.in)\n",
    )
    assert tools.script.exports.config_extras == ("cmake/tools-extras.cmake.in",)
    package = sources(HEAD + "find_package(tools REQUIRED)\ninstall_all(launch)\n", ("launch/a.launch.py",))
    script = evaluate(package, helpers={"tools": tools})
    assert not script.opaque
    assert paths(script) == {"share/pkg/launch/a.launch.py": False}
    assert [(mention.name, mention.via) for mention in script.mentions] == [("tools", "cmake")]
    assert str(script.products.installs[0].span) == "src/pkg/CMakeLists.txt:4:13"
    assert hidden(evaluate(package)) == ALL_FACETS


@pytest.mark.parametrize(("point", "facets"), [("ament_package", Facet.COMPONENTS), ("ament_lint_auto", Facet(0))])
def test_an_extension_of_ament_package_hides_components(point: str, facets: Facet) -> None:
    script = run(f"ament_register_extension({point} tools hook.cmake)\nament_package()\n")
    assert hidden(script) == facets


def test_config_extras_may_be_generated() -> None:
    configure = "configure_file(a.cmake.in a.cmake @ONLY)\n"
    script = run(f"{configure}ament_package(CONFIG_EXTRAS ${{CMAKE_CURRENT_BINARY_DIR}}/a.cmake gone.cmake)\n", ("a.cmake.in",))
    assert "share/pkg/cmake/a.cmake" in paths(script)
    assert "share/pkg/cmake/gone.cmake" not in paths(script)


def test_media_of_rviz_are_installed_with_their_folders() -> None:
    script = run("register_rviz_ogre_media_exports(DIRECTORIES ogre/materials)\n", ("ogre/materials/a.material",))
    assert paths(script) == {
        "share/pkg/ogre/materials/a.material": False,
        "share/ament_index/resource_index/rviz_ogre_media_exports/pkg": False,
    }


@pytest.mark.parametrize(
    "assignment", ["", "set(DISTRO $ENV{ROS_DISTRO})\n", "if(1)\nset(DISTRO ros-$ENV{ROS_DISTRO})\nendif()\n"]
)
def test_branches_for_other_distributions_are_optional(assignment: str) -> None:
    distribution = "${DISTRO}" if assignment else "$ENV{ROS_DISTRO}"
    text = f"{assignment}if({distribution} MATCHES humble)\nfind_package(a REQUIRED)\nelse()\nfind_package(b REQUIRED)\nendif()\n"
    mentions = mentioned(run(text))
    assert mentions["cmake", "a"].optional
    assert not mentions["cmake", "b"].optional


@pytest.mark.parametrize(
    ("block", "lost"),
    [
        ("macro(add)\n{}\nendmacro()\nadd()", False),
        ("if(WIN32 OR 1)\n{}\nendif()", False),
        ("foreach(i 1)\n{}\nendforeach()", False),
        ("function(add)\n{}\nendfunction()\nadd()", True),
        ("function(add)\n{}\nendfunction()\nfunction(all)\nadd()\nendfunction()\nall()", True),
        (
            "function(add)\n{}\nset(_RCLCPP_COMPONENTS_rclcpp_components__NODES "
            "${{_RCLCPP_COMPONENTS_rclcpp_components__NODES}} PARENT_SCOPE)\nendfunction()\nadd()",
            False,
        ),
        ("function(add)\n{}\nament_package()\nendfunction()\nadd()\nreturn()", False),
    ],
)
def test_components_registered_in_a_function_are_lost_to_ament_package(block: str, lost: bool) -> None:
    """The variables in which rclcpp_components stores its components end with the function that sets them."""
    script = run(block.format('rclcpp_components_register_nodes(core "ns::Node")') + "\nament_package()\n")
    assert [component.unregistered for component in script.products.components] == [lost]
    assert any("/rclcpp_components/" in path for path in paths(script)) is not lost


def test_the_command_for_components_until_dashing() -> None:
    script = run('add_library(c SHARED c.cpp)\nrclcpp_register_node_plugins(c "pkg::A" "pkg::B")\n', ("c.cpp",))
    assert [component.name for component in script.products.components] == ["pkg::A", "pkg::B"]


def test_ament_auto_package_scopes_headers_since_kilted() -> None:
    text = HEAD + "ament_auto_package({})\n"
    package = sources(text.format(""), ("include/pkg/a.hpp",))
    assert "include/pkg/a.hpp" in paths(evaluate(package, "jazzy"))
    assert "include/pkg/pkg/a.hpp" in paths(evaluate(package, "kilted"))
    package = sources(text.format("USE_SCOPED_HEADER_INSTALL_DIR"), ("include/pkg/a.hpp",))
    assert "include/pkg/pkg/a.hpp" in paths(evaluate(package, "humble"))


def test_ament_generate_version_header_installs_a_header() -> None:
    text = "ament_generate_version_header(a)\nament_generate_version_header(b HEADER_PATH b.h INSTALL_PATH include)\n"
    assert paths(run(text)) == {"include/pkg/pkg/version.h": False, "include/b.h": False}


def test_macros_of_middleware_implementations_hide_nothing() -> None:
    text = 'find_package(rmw)\nregister_rmw_implementation("c:a:b" "cpp:c:d")\nconfigure_rmw_library(a)\n'
    script = run(text)
    assert not script.opaque
    assert paths(script) == {"share/ament_index/resource_index/rmw_typesupport/pkg": False}


def test_no_command_fails_without_arguments() -> None:
    for name in sorted({*HANDLERS, *macros()}):
        if not name.startswith(("ros_lint_", "end", "else")):
            for arguments in ("", "${EMPTY}", "${EMPTY} ${EMPTY}", '""', "a", "a ${EMPTY} b"):
                run(f"add_library(a a.cpp)\n{name}({arguments})\n", ("a.cpp",))


@pytest.mark.parametrize(
    ("command", "hides"),
    [
        ("acme_set_compile_options(a)", Facet.USES | Facet.EXPORTS),
        ("pkg_acme_version(${PROJECT_NAME})", Facet.USES | Facet.EXPORTS),
        ("acme_add_filter(a)", Facet.USES | Facet.EXPORTS | Facet.EXECUTABLES | Facet.LIBRARIES),
        ("acme_static_library(a)", Facet.USES | Facet.EXPORTS | Facet.EXECUTABLES | Facet.LIBRARIES),
    ],
)
def test_unknown_commands_hide_targets_of_ament_auto_only_if_they_may_build(command: str, hides: Facet) -> None:
    script = run(f"find_package(ament_cmake_auto REQUIRED)\nfind_package(pk REQUIRED)\n{command}\nament_auto_package()")
    assert hidden(script) == hides


def test_private_macros_of_ament_are_known() -> None:
    script = run(
        "find_package(ament_cmake_python REQUIRED)\n_ament_cmake_python_register_environment_hook()\n"
        "_ament_cmake_gtest_find_gtest()\n_ament_cmake_gmock_find_gmock()\n"
    )
    assert not script.opaque
    assert "share/pkg/environment/pythonpath.sh" in paths(script)
