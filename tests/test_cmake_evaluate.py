"""What an evaluated CMakeLists.txt says of a package."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from ros_lint.collectors.cmake_syntax import parse
from ros_lint.facts.build import BuildScript
from ros_lint.facts.sight import Facet
from ros_lint.facts.sources import Mention
from ros_lint.interpret.cmake import evaluate
from ros_lint.interpret.cmake_sources import Helper, Sources
from ros_lint.text import Text

HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(pkg)\n"


def sources(script: str, files: Mapping[str, str] | tuple[str, ...] = (), **more: object) -> Sources:
    texts = {"CMakeLists.txt": script, "package.xml": "", **(dict.fromkeys(files, "") if isinstance(files, tuple) else files)}
    parsed = {
        path: parse(Text(f"src/pkg/{path}", text))
        for path, text in texts.items()
        if path.endswith(("CMakeLists.txt", ".cmake", ".cmake.in"))
    }
    return Sources("pkg", "src/pkg", sorted(texts), parsed, **more)  # type: ignore[arg-type]


def run(script: str, files: Mapping[str, str] | tuple[str, ...] = (), **more: object) -> BuildScript:
    return evaluate(sources(HEAD + script, files, **more), "jazzy")


def paths(script: BuildScript) -> dict[str, bool]:
    """Installed paths, and whether they are conditional."""
    return {provided.path: provided.conditional for provided in script.provides}


def mentioned(script: BuildScript) -> dict[tuple[str, str], Mention]:
    return {(mention.via, mention.name): mention for mention in script.mentions}


def hidden(script: BuildScript) -> Facet:
    facets = Facet(0)
    for opaque in script.opaque:
        facets |= opaque.hides
    return facets


# --- names and mentions ----------------------------------------------------------------------------------------------


def test_project() -> None:
    script = evaluate(sources('set(name pkg)\nproject("${name}" VERSION 1.2.3 LANGUAGES CXX)\n'))
    assert (script.name, script.version) == ("pkg", "1.2.3")
    assert script.name_span is not None
    assert str(script.name_span) == "src/pkg/CMakeLists.txt:1:10"


def test_an_unknown_name_is_none() -> None:
    assert run("").name == "pkg"
    assert evaluate(sources("find_package(x)\nproject(${x_NAME})\n")).name == ""


def test_mentions_stand_where_the_name_is_written() -> None:
    text = (
        HEAD
        + "set(DEPENDS\n  rclcpp\n  std_msgs\n)\nforeach(d IN ITEMS ${DEPENDS})\n  find_package(${d} REQUIRED)\nendforeach()\n"
    )
    script = evaluate(sources(text))
    source = Text("src/pkg/CMakeLists.txt", text)
    assert [(mention.name, source.slice(mention.span)) for mention in script.mentions] == [
        ("rclcpp", "rclcpp"),
        ("std_msgs", "std_msgs"),
    ]
    assert [mention.span.line for mention in script.mentions] == [4, 5]


@pytest.mark.parametrize(
    ("text", "optional", "test"),
    [
        ("find_package(a REQUIRED)", False, False),
        ("find_package(a)", False, False),
        ("find_package(a)\ntarget_link_libraries(t a::a)", False, False),
        ("find_package(a)\nset(X ${a_LIBRARIES})", False, False),
        ("find_package(a)\nif(BUILD_TESTING)\nament_target_dependencies(t a)\nendif()", False, True),
        ("find_package(a QUIET)", True, False),
        ("find_package(a QUIET REQUIRED)", False, False),
        ("find_package(a)\nif(a_FOUND)\nendif()", True, False),
        ("if(UNHEARD_OF)\nfind_package(a REQUIRED)\nendif()", None, False),
        ("find_package(b)\nif(b_VERSION VERSION_LESS 3)\nfind_package(a REQUIRED)\nendif()", True, False),
        ("option(WITH_A \"\" OFF)\nif(WITH_A)\nfind_package(a REQUIRED)\nendif()", True, False),
        ("option(WITH_A \"\" ON)\nif(WITH_A)\nfind_package(a REQUIRED)\nendif()", False, False),
        ("if(BUILD_TESTING)\nfind_package(a REQUIRED)\nendif()", False, True),
        ("if(BUILD_TESTING AND NOT WIN32)\nfind_package(a REQUIRED)\nendif()", False, True),
        ("if(NOT BUILD_TESTING)\nelse()\nfind_package(a REQUIRED)\nendif()", False, True),
        ("if(NOT BUILD_TESTING)\nreturn()\nendif()\nfind_package(a REQUIRED)", False, True),
        ("if(BUILD_TESTING)\nelse()\nfind_package(a REQUIRED)\nendif()", True, False),
        ("set(X FALSE)\nif(BUILD_TESTING)\nset(X TRUE)\nendif()\nif(X)\nfind_package(a REQUIRED)\nendif()", False, True),
        ("find_package(b)\nif(BUILD_TESTING AND b_OK)\nset(X 1)\nendif()\nif(X)\nfind_package(a)\nendif()", True, True),
        ("if(BUILD_TESTING)\nset(X 1)\nendif()\nset(X 1)\nif(X)\nfind_package(a REQUIRED)\nendif()", False, False),
        ("set(X 1)\nif(BUILD_TESTING)\nset(X 2)\nendif()\nif(X)\nfind_package(a REQUIRED)\nendif()", False, False),
        ("if(WIN32)\nfind_package(a REQUIRED)\nendif()", True, False),
        ("if(FALSE)\nfind_package(a REQUIRED)\nendif()", None, False),
        ("if($ENV{ROS_DISTRO} STREQUAL jazzy)\nfind_package(a REQUIRED)\nendif()", False, False),
        ("if($ENV{ROS_DISTRO} STREQUAL humble)\nfind_package(a REQUIRED)\nendif()", True, False),
        ("if(\"$ENV{ROS_VERSION}\" EQUAL 1)\nfind_package(a REQUIRED)\nendif()", None, False),
        ("if(\"$ENV{HOME}\" STREQUAL \"\")\nfind_package(a REQUIRED)\nendif()", True, False),
        ("return()\nfind_package(a REQUIRED)", None, False),
        ("find_package(b)\nif(NOT b_FOUND)\nreturn()\nendif()\nfind_package(a REQUIRED)", True, False),
        ("find_package(b)\nif(NOT b_FOUND)\nmessage(FATAL_ERROR)\nendif()\nfind_package(a REQUIRED)", False, False),
    ],
)  # fmt: skip
def test_what_guards_a_mention(text: str, optional: bool | None, test: bool) -> None:
    mention = mentioned(run(text)).get(("cmake", "a"))
    assert (mention and mention.optional) == optional
    assert (mention.test if mention else False) == test


def test_targets_and_variables_of_other_packages() -> None:
    script = run(
        "find_package(rclcpp REQUIRED)\nfind_package(OpenCV REQUIRED)\nadd_library(core a.cpp)\n"
        "add_library(pkg::core ALIAS core)\n"
        "target_link_libraries(core PUBLIC rclcpp::rclcpp $<BUILD_INTERFACE:fmt::fmt> ${OpenCV_LIBS} "
        "${std_msgs_TARGETS} pkg::core)\n"
        "ament_target_dependencies(core PUBLIC std_msgs)\nament_export_dependencies(rclcpp)\n",
        ("a.cpp",),
    )
    targets = {(mention.name, mention.what, mention.purpose) for mention in script.mentions if mention.via == "target"}
    assert targets == {
        ("rclcpp::rclcpp", "", ""), ("fmt::fmt", "", ""), ("OpenCV", "${OpenCV_LIBS}", ""),
        ("std_msgs", "ament_target_dependencies of std_msgs", ""),
        ("rclcpp", "ament_export_dependencies rclcpp", "export"),
    }  # fmt: skip


def test_macros_mention_the_package_that_brings_them() -> None:
    script = run("if(BUILD_TESTING)\n  ament_add_gtest(t test/t.cpp)\nendif()\nament_package()\n", ("test/t.cpp",))
    mention = mentioned(script)[("macro", "ament_cmake_gtest")]
    assert (mention.what, mention.test, mention.span.line, mention.span.column) == ("ament_add_gtest()", True, 4, 3)
    assert [(target.name, target.sources, target.test) for target in script.targets] == [("t", ("test/t.cpp",), True)]
    assert {"ament_add_gtest", "ament_package"} <= set(script.calls)


def test_the_place_for_install_rules_is_before_ament_package() -> None:
    script = run("\n  ament_package()\n")
    assert str(script.end) == "src/pkg/CMakeLists.txt:4:3"
    assert run("if(UNHEARD_OF)\nelse()\nament_package()\nendif()").end is not None
    assert run("").end is None


# --- what is installed -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("install(TARGETS node DESTINATION lib/${PROJECT_NAME})", {"lib/pkg/node": False}),
        ("install(TARGETS node RUNTIME DESTINATION lib/${PROJECT_NAME})", {"lib/pkg/node": False}),
        ("install(TARGETS node)", {"bin/node": False}),
        ("install(TARGETS core node EXPORT e ARCHIVE DESTINATION lib LIBRARY DESTINATION lib RUNTIME DESTINATION bin)",
         {"lib/libcore.so": False, "bin/node": False}),
        ("set_target_properties(node PROPERTIES OUTPUT_NAME talker)\n"
            "install(TARGETS node DESTINATION lib/pkg)", {"lib/pkg/talker": False}),
        ("install(TARGETS node DESTINATION lib/pkg)\n"
            "set_target_properties(node PROPERTIES OUTPUT_NAME talker)", {"lib/pkg/talker": False}),
        ("foreach(t node)\ninstall(TARGETS ${t} DESTINATION lib/pkg)\nendforeach()", {"lib/pkg/node": False}),
        ("install(PROGRAMS scripts/a.py DESTINATION lib/pkg RENAME a)", {"lib/pkg/a": False}),
        ("install(DIRECTORY launch DESTINATION share/pkg)", {"share/pkg/launch/a.launch.py": False}),
        ("install(DIRECTORY launch/ DESTINATION share/pkg)", {"share/pkg/a.launch.py": False}),
        ("install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/launch DESTINATION ${CMAKE_INSTALL_PREFIX}/share/pkg)",
         {"share/pkg/launch/a.launch.py": False}),
        ("file(GLOB found scripts/*.py)\ninstall(PROGRAMS ${found} DESTINATION lib/pkg)", {"lib/pkg/a.py": False}),
        ("file(GLOB_RECURSE found RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.launch.py)\n"
            "install(FILES ${found} DESTINATION share/pkg)", {"share/pkg/a.launch.py": False}),
        ("install(FILES ${CMAKE_CURRENT_BINARY_DIR}/made.yaml DESTINATION share/pkg)", {"share/pkg/made.yaml": False}),
        ("install(FILES gone.yaml DESTINATION share/pkg OPTIONAL)", {}),
        ("if($ENV{SOMETHING})\ninstall(DIRECTORY launch DESTINATION share/pkg)\n"
            "endif()", {"share/pkg/launch/a.launch.py": True}),
        ("set(dirs launch)\nif($ENV{SOMETHING})\nlist(APPEND dirs scripts)\nendif()\n"
            "install(DIRECTORY ${dirs} DESTINATION share/pkg)",
         {"share/pkg/launch/a.launch.py": False, "share/pkg/scripts/a.py": True}),
        ("option(ALL \"\" OFF)\nif(ALL)\ninstall(DIRECTORY launch DESTINATION share/pkg)\n"
            "endif()", {"share/pkg/launch/a.launch.py": True}),
        ("if(BUILD_TESTING)\ninstall(DIRECTORY launch DESTINATION share/pkg)\nendif()", {"share/pkg/launch/a.launch.py": True}),
        ("function(put dir)\ninstall(DIRECTORY ${dir} DESTINATION share/${PROJECT_NAME})\nendfunction()\n"
            "put(launch)", {"share/pkg/launch/a.launch.py": False}),
        ("macro(put)\ninstall(DIRECTORY ${ARGN} DESTINATION share/${PROJECT_NAME})\nendmacro()\n"
            "put(launch scripts)", {"share/pkg/launch/a.launch.py": False, "share/pkg/scripts/a.py": False}),
        ("include(GNUInstallDirs)\ninstall(FILES launch/a.launch.py DESTINATION ${CMAKE_INSTALL_DATADIR}/pkg)",
         {"share/pkg/a.launch.py": False}),
        ("add_subdirectory(scripts)", {"share/pkg/a.py": False}),
        ("include(cmake/more.cmake)", {"share/pkg/a.launch.py": False}),
        ("list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_SOURCE_DIR}/cmake)\ninclude(more)", {"share/pkg/a.launch.py": False}),
    ],
)  # fmt: skip
def test_installed_paths(text: str, expected: dict[str, bool]) -> None:
    files = {
        "launch/a.launch.py": "",
        "scripts/a.py": "",
        "scripts/CMakeLists.txt": "install(FILES a.py DESTINATION share/pkg)",
        "cmake/more.cmake": "install(FILES ${CMAKE_CURRENT_LIST_DIR}/../launch/a.launch.py DESTINATION share/pkg)",
        "n.cpp": "",
    }
    if "scripts" in expected or "install(DIRECTORY" in text:
        files["scripts/CMakeLists.txt"] = ""
    script = run(f"add_executable(node n.cpp)\nadd_library(core SHARED n.cpp)\n{text}\n", files)
    found = {path: conditional for path, conditional in paths(script).items() if not path.endswith("CMakeLists.txt")}
    assert found == expected
    assert not script.opaque
    assert not script.problems


def test_programs() -> None:
    files = ("scripts/a.py", "scripts/b.py")
    text = "install(DIRECTORY scripts/ DESTINATION lib/pkg {})\n"
    plain = run(text.format(""), files, executables=frozenset({"scripts/a.py"}))
    assert [provided.program for provided in plain.provides] == [False, False]
    kept = run(text.format("USE_SOURCE_PERMISSIONS"), files, executables=frozenset({"scripts/a.py"}))
    assert [provided.program for provided in kept.provides] == [True, False]


def test_ament_auto() -> None:
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
    assert [(component.name, component.span.line) for component in script.components] == [("ns::Node", 7)]
    assert {target.name: target.sources for target in script.targets} == {
        "core": ("src/core.cpp",), "talker": ("src/core.cpp", "src/main.cpp"), "node": (),
    }  # fmt: skip
    assert {provided.path: provided.span.line for provided in script.provides}["lib/pkg/node"] == 7


def test_interfaces() -> None:
    script = run(
        'set(msgs "msg/A.msg" "msg/B.msg")\n'
        'rosidl_generate_interfaces(${PROJECT_NAME} ${msgs} "srv/C.srv" DEPENDENCIES std_msgs)\n',
        ("msg/A.msg", "msg/B.msg", "srv/C.srv"),
    )
    assert script.interfaces == ("msg/A", "msg/B", "srv/C")
    assert script.python_packages == ("pkg",)
    assert {"share/pkg/msg/A.msg", "share/pkg/msg/A.idl", "share/pkg/srv/C.srv"} <= paths(script).keys()
    assert mentioned(script)[("target", "std_msgs")].purpose == "interfaces"
    assert mentioned(script)[("macro", "rosidl_default_generators")].purpose == "interfaces"


def test_python_packages() -> None:
    files = ("pkg_py/__init__.py", "pkg_py/sub/__init__.py", "pkg_py/sub/x.py", "setup.cfg")
    texts = {"setup.cfg": "[options.entry_points]\nconsole_scripts =\n    tool = pkg_py.sub.x:main\n"}
    text = "ament_python_install_package(pkg_py SCRIPTS_DESTINATION lib/${PROJECT_NAME})\n"
    script = run(text, files, texts=texts)
    assert script.python_packages == ("pkg_py", "pkg_py.sub")
    assert paths(script).keys() >= {"lib/python/site-packages/pkg_py/sub/x.py", "lib/pkg/tool"}
    assert not script.opaque
    assert hidden(run(text, files)) == Facet.EXECUTABLES


def test_plugins_use_the_package_of_their_base_class() -> None:
    script = run("pluginlib_export_plugin_description_file(nav2_core plugins.xml)\n", ("plugins.xml",))
    assert paths(script).keys() >= {"share/pkg/plugins.xml"}
    loader = mentioned(script)[("target", "nav2_core")]
    assert (loader.what, loader.purpose) == ("plugins for nav2_core", "plugins")


# --- what is wrong, and what cannot be seen ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "kinds"),
    [
        ("add_executable(a gone.cpp)", ["missing-file"]),
        ("add_executable(a src/a)", []),
        ("install(FILES gone.yaml DESTINATION share/pkg)", ["missing-file"]),
        ("install(DIRECTORY gone DESTINATION share/pkg)", ["missing-file"]),
        ("install(DIRECTORY src/a.cpp DESTINATION share/pkg)", ["directory-is-file"]),
        ("install(FILES src DESTINATION share/pkg)", ["file-is-directory"]),
        ("install(FILES out/x DESTINATION share/pkg)", []),
        ("if($ENV{X})\ninstall(FILES gone.yaml DESTINATION share/pkg)\nendif()", []),
        ("configure_file(a.in ${CMAKE_CURRENT_SOURCE_DIR}/made.cpp)\nadd_library(a made.cpp)", []),
        ("add_custom_command(OUTPUT ${CMAKE_CURRENT_SOURCE_DIR}/made.cpp COMMAND x)\nadd_library(a made.cpp)", []),
        ("add_subdirectory(gone)", ["missing-file"]),
        ("include(gone.cmake)", ["missing-file"]),
        ("include(gone.cmake OPTIONAL)", []),
        ("install(TARGETS nobody DESTINATION lib)", ["undefined-target"]),
        ("rosidl_generate_interfaces(pkg msg/Gone.msg)", ["missing-file"]),
        ("if(TRUE)\n", ["cmake-syntax"]),
        ("endif()\n", ["cmake-syntax"]),
        ("set(a", ["cmake-syntax"]),
    ],
)
def test_problems(text: str, kinds: list[str]) -> None:
    assert [problem.kind for problem in run(text, ("src/a.cpp",), unseen=("out",)).problems] == kinds


@pytest.mark.parametrize(
    ("text", "facets"),
    [
        ("message(STATUS x)", Facet(0)),
        ("find_package(b)\nfind_package(${b_THING} REQUIRED)", Facet.USES),
        ("what_is_this(a b)", Facet.USES),
        ("find_package(b)\ninstall(FILES ${b_FILES} DESTINATION share/pkg)", Facet.SHARE),
        ("find_package(b)\ninstall(PROGRAMS ${b_FILES} DESTINATION lib/pkg)", Facet.EXECUTABLES),
        ("find_package(b)\ninstall(TARGETS ${b_TARGETS} DESTINATION lib/pkg)", Facet.EXECUTABLES | Facet.LIBRARIES),
        ("find_package(b)\nadd_library(${b_NAMES} x.cpp)", Facet.LIBRARIES),
        ("ExternalProject_Add(x URL y)", Facet.USES | Facet.LIBRARIES),
        ('install(CODE "execute_process(COMMAND x)")', Facet(0)),
        ('option(A "" OFF)\nif(A)\nfind_package(b)\ninstall(FILES ${b_FILES} DESTINATION share/pkg)\nendif()', Facet(0)),
        ('option(A "" OFF)\nif(A)\nwhat_is_this()\nendif()', Facet.USES),
        ("find_package(b)\nfind_package(Qt${b_VERSION})", Facet(0)),
        ("find_package(b)\nset(x ${b_A})\nadd_library(x ${x})", Facet(0)),
        ("find_package(b)\nwhile(b_A)\nset(x ${x}y)\nendwhile()", Facet(0)),
    ],
)
def test_what_cannot_be_seen(text: str, facets: Facet) -> None:
    assert hidden(run(text)) == facets


@pytest.mark.parametrize("text", ["while(TRUE)\nendwhile()", "macro(m)\nm()\nendmacro()\nm()", "include(CMakeLists.txt)"])
def test_endless_scripts_end(text: str) -> None:
    assert hidden(run(text)) & Facet.EXECUTABLES


def test_values_do_not_grow_without_end() -> None:
    script = run("set(x aaaaaaaaaa)\nforeach(i RANGE 60)\nset(x ${x}${x})\nendforeach()\n")
    assert not script.opaque


def test_no_script() -> None:
    script = evaluate(Sources("pkg", "", (), {}))
    assert hidden(script) & Facet.USES
    assert str(script.opaque[0].span) == "CMakeLists.txt:1:1"


# --- CMake code of other packages of the workspace -----------------------------------------------------------------------


def helper(name: str, files: Mapping[str, str], script: str) -> Helper:
    parsed = {path: parse(Text(f"src/{name}/{path}", text)) for path, text in {"CMakeLists.txt": script, **files}.items()}
    found = Sources(name, f"src/{name}", sorted(parsed), parsed)
    return Helper(found, evaluate(found))


def test_macros_of_the_workspace_are_followed() -> None:
    tools = helper(
        "tools",
        {
            "cmake/tools-extras.cmake.in": 'include("${tools_DIR}/install_all.cmake")\nfind_package(rclcpp REQUIRED)\n',
            "cmake/install_all.cmake": "macro(install_all)\n"
            "install(DIRECTORY ${ARGN} DESTINATION share/${PROJECT_NAME})\nendmacro()\n",
        },
        "project(tools)\ninstall(FILES cmake/install_all.cmake DESTINATION share/tools/cmake)\n"
        "ament_package(CONFIG_EXTRAS cmake/tools-extras.cmake.in)\n",
    )
    assert tools.script.extras == ("cmake/tools-extras.cmake.in",)
    found = sources(HEAD + "find_package(tools REQUIRED)\ninstall_all(launch)\n", ("launch/a.launch.py",))
    script = evaluate(found, helpers={"tools": tools})
    assert not script.opaque
    assert paths(script) == {"share/pkg/launch/a.launch.py": False}
    assert [(mention.name, mention.via) for mention in script.mentions] == [("tools", "cmake")]
    assert str(script.provides[0].span) == "src/pkg/CMakeLists.txt:4:13"
    assert (
        hidden(evaluate(found))
        == Facet.USES | Facet.EXECUTABLES | Facet.SHARE | Facet.PYTHON | Facet.LIBRARIES | Facet.INTERFACES | Facet.COMPONENTS
    )


def test_code_for_other_distributions_counts_as_possible() -> None:
    text = "if($ENV{ROS_DISTRO} MATCHES humble)\nfind_package(a REQUIRED)\nelse()\nfind_package(b REQUIRED)\nendif()\n"
    found = mentioned(run(text))
    assert found["cmake", "a"].optional
    assert not found["cmake", "b"].optional


@pytest.mark.parametrize(
    ("around", "lost"),
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
def test_components_are_registered_where_ament_package_sees_them(around: str, lost: bool) -> None:
    """A function's variables are gone when it ends, those in which rclcpp_components notes its components among them."""
    script = run(around.format('rclcpp_components_register_nodes(core "ns::Node")') + "\nament_package()\n")
    assert [component.lost for component in script.components] == [lost]
    assert any("/rclcpp_components/" in path for path in paths(script)) is not lost


def test_the_name_of_components_until_dashing() -> None:
    script = run('add_library(c SHARED c.cpp)\nrclcpp_register_node_plugins(c "pkg::A" "pkg::B")\n', ("c.cpp",))
    assert [component.name for component in script.components] == ["pkg::A", "pkg::B"]


def test_what_another_system_has() -> None:
    text = "if(WIN32)\nfind_package(xa REQUIRED)\nelse()\nfind_package(xb REQUIRED)\nendif()\n"
    script = run(f"{text}if(MSVC OR APPLE)\nx_install()\nendif()\n")
    assert mentioned(script)["cmake", "xa"].optional
    assert not mentioned(script)["cmake", "xb"].optional
    assert hidden(script) == Facet.USES


def test_what_a_download_says_of_itself_is_not_known() -> None:
    script = run(
        "file(DOWNLOAD https://a.b/c data/c STATUS state LOG said)\nlist(GET state 0 code)\n"
        "if(NOT ${code} EQUAL 0)\nmessage(FATAL_ERROR ${said})\nendif()\n"
        "install(FILES a.yaml DESTINATION share/pkg)\n",
        ("a.yaml",),
    )
    assert paths(script) == {"share/pkg/a.yaml": False}
    assert not hidden(script)


def test_where_all_that_goes_on_ends_in_an_error_all_is_hidden() -> None:
    stopped = run("find_package(x)\nif(NOT x_FOUND)\nreturn()\nendif()\nmessage(FATAL_ERROR no)\nadd_executable(a a.cpp)\n")
    assert hidden(stopped) & Facet.EXECUTABLES


def test_a_target_that_nobody_defines_hides_nothing_else() -> None:
    script = run("add_executable(a a.cpp)\ninstall(TARGETS a b DESTINATION lib/pkg)\n", ("a.cpp",))
    assert paths(script)["lib/pkg/a"] is False
    assert paths(script)["lib/pkg/b"] is True
    assert not hidden(script)
    assert [problem.kind for problem in script.problems] == ["undefined-target"]
    script = run("find_package(x)\nx_make(b)\ninstall(TARGETS b DESTINATION lib/pkg)\n")
    assert hidden(script) & Facet.EXECUTABLES


def test_lists_that_are_empty_install_nothing() -> None:
    script = run("install(TARGETS ${none} DESTINATION lib)\ninstall(DIRECTORY ${none} DESTINATION share/pkg)\n")
    assert paths(script).keys() <= {"share/pkg/package.xml"}
    assert not hidden(script)
    assert not script.problems


def test_properties_of_a_target_from_a_branch() -> None:
    branch = "add_library(a SHARED a.cpp)\nset_target_properties(a PROPERTIES VERSION 1.2)\ninstall(TARGETS a DESTINATION lib)\n"
    script = run(f"find_package(x)\nif(x_FOUND)\n{branch}endif()\n", ("a.cpp",))
    assert paths(script) == {"lib/liba.so": True, "lib/liba.so.1.2": True}


def test_modules_in_c_plus_plus() -> None:
    text = "pybind11_add_module(_core core.cpp)\ninstall(TARGETS _core DESTINATION ${PYTHON_INSTALL_DIR}/pkg)\n"
    script = run(text, ("core.cpp",))
    assert paths(script) == {"lib/python/site-packages/pkg/_core.so": False}
    assert script.python_packages == ("pkg._core",)
    assert not hidden(script)


def test_folders_that_are_not_looked_into_are_installed_all_the_same() -> None:
    text = HEAD + "install(DIRECTORY share/ DESTINATION share/pkg)\n"
    listed = {"share/build": ["share/build/a.txt", "share/build/b/c.txt"], "gone": []}
    given = sources(text, ("share/a",), unseen=("share/build", "gone"), look=lambda folder: listed[folder])
    script = evaluate(given)
    assert paths(script) == {"share/pkg/a": False, "share/pkg/build/a.txt": False, "share/pkg/build/b/c.txt": False}
    assert not hidden(script)
    script = evaluate(given._replace(look=lambda folder: ()))
    assert hidden(script) & Facet.SHARE


def test_headers_of_ament_auto_package() -> None:
    text = HEAD + "ament_auto_package({})\n"
    given = sources(text.format(""), ("include/pkg/a.hpp",))
    assert "include/pkg/a.hpp" in paths(evaluate(given, "jazzy"))
    assert "include/pkg/pkg/a.hpp" in paths(evaluate(given, "kilted"))
    given = sources(text.format("USE_SCOPED_HEADER_INSTALL_DIR"), ("include/pkg/a.hpp",))
    assert "include/pkg/pkg/a.hpp" in paths(evaluate(given, "humble"))


def test_version_header() -> None:
    text = "ament_generate_version_header(a)\nament_generate_version_header(b HEADER_PATH b.h INSTALL_PATH include)\n"
    assert paths(run(text)) == {"include/pkg/pkg/version.h": False, "include/b.h": False}


def test_words_of_install_targets_elsewhere() -> None:
    text = "install(DIRECTORY launch ARCHIVE DESTINATION lib LIBRARY DESTINATION lib)\n"
    (problem,) = run(text, ("launch/a.launch.py",)).problems
    assert problem.message == "install(DIRECTORY) knows no ARCHIVE, that belongs to install(TARGETS)"
    assert problem.span.column == len("install(DIRECTORY launch ") + 1


def test_what_targets_are_linked_with() -> None:
    text = """
    set(DEPS a pkg::b rclcpp::rclcpp)
    add_executable(e e.cpp)
    foreach(target e)
      target_link_libraries(${target} PRIVATE ${DEPS})
    endforeach()
    add_library(a SHARED a.cpp)
    add_library(b SHARED b.cpp)
    add_library(pkg::b ALIAS b)
    if(UNKNOWN_FOUND)
      target_link_libraries(a b)
    endif()
    """
    script = run(f"find_package(UNKNOWN)\n{text}", ("a.cpp", "b.cpp", "e.cpp"))
    links = {target.name: [name for name, _ in target.links] for target in script.targets}
    assert links == {"e": ["a", "b"], "a": [], "b": []}


def test_what_configure_file_makes_is_installed_with_its_folder() -> None:
    text = """
    configure_file(a.h.in include/pkg/a.h)
    configure_file(b.h.in ${PROJECT_BINARY_DIR}/include/pkg/b.h COPYONLY)
    configure_file(c.in c)
    install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/include/ DESTINATION include/pkg)
    install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/include DESTINATION x PATTERN b.h EXCLUDE)
    """
    script = run(text)
    assert paths(script).keys() == {"include/pkg/pkg/a.h", "include/pkg/pkg/b.h", "x/include/pkg/a.h"}
    assert hidden(script) & Facet.LIBRARIES


def test_many_ways_out_do_not_make_a_script_long() -> None:
    text = "".join(f"find_package(p{number})\nif(p{number}_FOUND)\nreturn()\nendif()\n" for number in range(50))
    script = run(text + "set(a b)\n" * 2000 + "install(FILES a.txt DESTINATION share/pkg)\n", ("a.txt",))
    assert paths(script)["share/pkg/a.txt"] is True


@pytest.mark.parametrize(
    "line",
    [
        'list(TRANSFORM L APPEND "${L}")',
        'string(REPLACE a "${L}" L "${L}")',
        'string(REGEX REPLACE "a" "${L}" L "${L}")',
        'string(JOIN "${L}" L ${L})',
        "set(L ${L} ${L} ${L})",
        'set(L "${L}${L}${L}")',
    ],
)
def test_texts_that_grow_and_grow_become_unknown(line: str) -> None:
    script = run(f'set(L "a;a")\nforeach(i RANGE 60)\n{line}\nendforeach()\ninstall(FILES ${{L}} DESTINATION share/pkg)\n')
    assert hidden(script) & Facet.SHARE
