"""Packages that a script mentions, and the conditions of the mentions."""

from __future__ import annotations

import pytest

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.evaluate import evaluate
from tests.cmake_runs import HEAD, mentioned, run, sources


def test_mentions_are_placed_at_the_written_name() -> None:
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
        ("find_package(a 4.0)\nif(NOT a_FOUND)\nmessage(FATAL_ERROR \"no a\")\nendif()", False, False),
        ("find_package(a QUIET)\nif(NOT ${a_FOUND})\nmessage(FATAL_ERROR \"no a\")\nendif()", False, False),
        ("find_package(a)\nif(a_FOUND)\nset(X 1)\nelse()\nmessage(FATAL_ERROR \"no a\")\nendif()", False, False),
        ("find_package(a)\nfind_package(b)\nif(NOT b_FOUND OR NOT a_FOUND)\nmessage(FATAL_ERROR \"no\")\nendif()", False, False),
        ("find_package(a)\nfind_package(b)\nif(NOT b_FOUND AND NOT a_FOUND)\nmessage(FATAL_ERROR \"no\")\nendif()", True, False),
        ("find_package(a)\nif(NOT a_FOUND)\nmessage(WARNING \"no a\")\nendif()", True, False),
        ("find_package(a)\nif(WITH_A)\nif(NOT a_FOUND)\nmessage(FATAL_ERROR \"\")\nendif()\nendif()", True, False),
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
def test_conditions_make_mentions_optional_or_for_tests(text: str, optional: bool | None, test: bool) -> None:
    mention = mentioned(run(text)).get(("cmake", "a"))
    assert (mention and mention.optional) == optional
    assert (mention.test if mention else False) == test


@pytest.mark.parametrize("name", ["catkin", "roscpp"])
def test_packages_of_ros_1_are_not_found(name: str) -> None:
    search = f"find_package({name} QUIET)\nif({name}_FOUND)\ncatkin_package()\n"
    script = run(f"{search}find_package(a REQUIRED)\nelse()\nfind_package(b REQUIRED)\nendif()\n")
    assert not script.opaque
    mentions = mentioned(script)
    assert ("cmake", "a") not in mentions
    assert not mentions["cmake", "b"].optional


def test_the_build_tool_in_the_manifest_is_found() -> None:
    search = "find_package(ament_cmake QUIET)\nif(ament_cmake_FOUND)\n"
    text = f"{search}find_package(a REQUIRED)\nelse()\nfind_package(b REQUIRED)\nendif()\n"
    mentions = mentioned(run(text, build_depends=("ament_cmake",)))
    assert not mentions["cmake", "a"].optional
    assert ("cmake", "b") not in mentions
    mentions = mentioned(run(text))
    assert mentions["cmake", "a"].optional
    assert mentions["cmake", "b"].optional


def test_targets_and_variables_mention_their_package() -> None:
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
        ("std_msgs", "ament_target_dependencies(... std_msgs)", ""),
        ("rclcpp", "ament_export_dependencies(rclcpp)", "export"),
    }  # fmt: skip


def test_the_prefix_of_pkg_check_modules_is_not_a_package() -> None:
    script = run(
        "find_package(Eigen3 REQUIRED)\npkg_check_modules(EIGEN3 eigen3)\npkg_check_modules(libcamera REQUIRED libcamera>=0.1)\n"
        "add_library(core a.cpp)\n"
        "target_include_directories(core PUBLIC ${libcamera_INCLUDE_DIRS} ${EIGEN3_INCLUDE_DIRS})\n",
        ("a.cpp",),
    )
    assert [mention.name for mention in script.mentions if mention.via == "target"] == ["Eigen3"]


def test_linked_targets_of_the_package_are_listed() -> None:
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
    links = {target.name: [name for name, _ in target.links] for target in script.products.targets}
    assert links == {"e": ["a", "b"], "a": [], "b": []}
