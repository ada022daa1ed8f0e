"""Evaluation of CMakeLists.txt: installed files, problems and what is hidden."""

from __future__ import annotations

import pytest

from ros_lint.collectors.cmake.evaluate import evaluate
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.facts.visibility import ALL_FACETS, Facet
from tests.cmake_runs import HEAD, hidden, mentioned, paths, run, sources


def test_project_sets_name_and_version() -> None:
    script = evaluate(sources('set(name pkg)\nproject("${name}" VERSION 1.2.3 LANGUAGES CXX)\n'))
    assert (script.project.name, script.project.version) == ("pkg", "1.2.3")
    assert script.project.name_span is not None
    assert str(script.project.name_span) == "src/pkg/CMakeLists.txt:1:10"


def test_an_unknown_project_name_is_empty() -> None:
    assert run("").project.name == "pkg"
    assert evaluate(sources("find_package(x)\nproject(${x_NAME})\n")).project.name == ""


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
        ("include(GNUInstallDirs)\ninstall(FILES package.xml DESTINATION ${CMAKE_INSTALL_DOCDIR})",
         {"share/doc/pkg/package.xml": False}),
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
def test_install_commands_give_the_installed_paths(text: str, expected: dict[str, bool]) -> None:
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
    installed = {path: conditional for path, conditional in paths(script).items() if not path.endswith("CMakeLists.txt")}
    assert installed == expected
    assert not script.opaque
    assert not script.problems


def test_directories_keep_the_executable_bit_only_with_use_source_permissions() -> None:
    files = ("scripts/a.py", "scripts/b.py")
    text = "install(DIRECTORY scripts/ DESTINATION lib/pkg {})\n"
    without_permissions = run(text.format(""), files, executables=frozenset({"scripts/a.py"}))
    assert [provided.program for provided in without_permissions.products.installs] == [False, False]
    with_permissions = run(text.format("USE_SOURCE_PERMISSIONS"), files, executables=frozenset({"scripts/a.py"}))
    assert [provided.program for provided in with_permissions.products.installs] == [True, False]


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
        ("add_subdirectory(gone)", ["missing-folder"]),
        ("include(gone.cmake)", ["missing-script"]),
        ("include(gone.cmake OPTIONAL)", []),
        ("install(TARGETS unknown DESTINATION lib)", ["undefined-target"]),
        ("rosidl_generate_interfaces(pkg msg/Gone.msg)", ["missing-file"]),
        ("if(TRUE)\n", ["cmake-syntax"]),
        ("endif()\n", ["cmake-syntax"]),
        ("set(a", ["cmake-syntax"]),
    ],
)
def test_errors_of_commands_are_reported_by_kind(text: str, kinds: list[str]) -> None:
    assert [problem.kind for problem in run(text, ("src/a.cpp",), unlisted_folders=("out",)).problems] == kinds


@pytest.mark.parametrize(
    ("text", "facets"),
    [
        ("message(STATUS x)", Facet(0)),
        ("find_package(b)\nfind_package(${b_THING} REQUIRED)", Facet.USES),
        ("what_is_this(a b)", Facet.USES | Facet.EXPORTS),
        ("find_package(b)\ninstall(FILES ${b_FILES} DESTINATION share/pkg)", Facet.SHARE),
        ("find_package(b)\ninstall(PROGRAMS ${b_FILES} DESTINATION lib/pkg)", Facet.EXECUTABLES),
        ("find_package(b)\ninstall(TARGETS ${b_TARGETS} DESTINATION lib/pkg)", Facet.EXECUTABLES | Facet.LIBRARIES),
        ("find_package(b)\nadd_library(${b_NAMES} x.cpp)", Facet.LIBRARIES),
        ("ExternalProject_Add(x URL y)", Facet.USES | Facet.LIBRARIES),
        ('install(CODE "execute_process(COMMAND x)")', Facet(0)),
        ('option(A "" OFF)\nif(A)\nfind_package(b)\ninstall(FILES ${b_FILES} DESTINATION share/pkg)\nendif()', Facet(0)),
        ('option(A "" OFF)\nif(A)\nwhat_is_this()\nendif()', Facet.USES | Facet.EXPORTS),
        ("find_package(b)\nfind_package(Qt${b_VERSION})", Facet(0)),
        ("find_package(b)\nset(x ${b_A})\nadd_library(x ${x})", Facet(0)),
        ("find_package(b)\nwhile(b_A)\nset(x ${x}y)\nendwhile()", Facet(0)),
    ],
)
def test_unknown_values_hide_the_facet_that_they_may_change(text: str, facets: Facet) -> None:
    assert hidden(run(text)) == facets


@pytest.mark.parametrize("text", ["while(TRUE)\nendwhile()", "macro(m)\nm()\nendmacro()\nm()", "include(CMakeLists.txt)"])
def test_an_endless_script_stops_at_the_limit(text: str) -> None:
    assert hidden(run(text)) & Facet.EXECUTABLES


def test_several_unknown_elements_are_any_number_of_rounds() -> None:
    loops = "".join(f"foreach(i{depth} $ENV{{A}} $ENV{{B}} $ENV{{C}})\n" for depth in range(7))
    script = run(
        f"{loops}install(FILES package.xml DESTINATION lib/pkg)\n{'endforeach()' * 7}".replace(")endforeach", ")\nendforeach")
    )
    assert paths(script) == {"lib/pkg/package.xml": True}
    assert hidden(script) == Facet(0), "6^7 rounds exceed the budget, 2^7 do not"


@pytest.mark.parametrize(
    "loop", ["foreach(i RANGE 900)\n{}endforeach()", "while(n LESS 900)\nmath(EXPR n ${{n}}+1)\n{}endwhile()"]
)
def test_a_loop_with_a_possible_break_in_each_round_stops_at_the_limit(loop: str) -> None:
    script = "find_package(b)\nset(n 0)\n" + loop.format("if(b_A${i}${n})\nbreak()\nendif()\n")
    assert hidden(run(script)) & Facet.EXECUTABLES


@pytest.mark.parametrize(
    "piece",
    ["if(b_A{})\nreturn()\nendif()\n", "if(b_A{})\nset(x{} y)\n", "if(TRUE)\nset(x{} y)\n"],
    ids=["leave", "nest", "deep"],
)
def test_many_unknown_conditions_stop_at_the_limit(piece: str) -> None:
    script = "find_package(b)\n" + "".join(piece.format(number, number) for number in range(900))
    assert hidden(run(script + "endif()\n" * (script.count("if(") - script.count("endif()")))) & Facet.EXECUTABLES


def test_a_value_that_doubles_in_each_round_hides_nothing() -> None:
    script = run("set(x aaaaaaaaaa)\nforeach(i RANGE 60)\nset(x ${x}${x})\nendforeach()\n")
    assert not script.opaque


_HUGE = "9" * 5000


@pytest.mark.parametrize(
    "line",
    [
        f"math(EXPR x {_HUGE}+1)",
        f"cmake_minimum_required(VERSION {_HUGE})",
        f"cmake_minimum_required(VERSION 3.{_HUGE})",
        'cmake_parse_arguments(PARSE_ARGV ² A "" "" "")',
        'string(REGEX REPLACE "a" "\\\\²" x "a")',
        "file(GLOB x [z-a])",
        'string(REPEAT "" 99999999999999999999 x)',
        "set(CMAKE_MATCH_COUNT x)\nstring(REGEX MATCH a x a)\nset(CMAKE_MATCH_COUNT 999999999)\nstring(REGEX MATCH a x a)",
    ],
)
def test_invalid_numbers_and_patterns_do_not_stop_a_script(line: str) -> None:
    assert paths(run(f"{line}\ninstall(FILES package.xml DESTINATION share/pkg)")) == {"share/pkg/package.xml": False}


def test_a_package_without_a_script_hides_its_uses() -> None:
    script = evaluate(Sources("pkg", "", (), {}))
    assert hidden(script) & Facet.USES
    assert str(script.opaque[0].span) == "CMakeLists.txt:1:1"


def test_branches_for_other_systems_are_optional() -> None:
    text = "if(WIN32)\nfind_package(xa REQUIRED)\nelse()\nfind_package(xb REQUIRED)\nendif()\n"
    script = run(f"{text}if(MSVC OR APPLE)\nx_install()\nendif()\n")
    assert mentioned(script)["cmake", "xa"].optional
    assert not mentioned(script)["cmake", "xb"].optional
    assert hidden(script) == Facet.USES | Facet.EXPORTS


def test_the_status_of_a_download_is_unknown() -> None:
    script = run(
        "file(DOWNLOAD https://a.b/c data/c STATUS state LOG said)\nlist(GET state 0 code)\n"
        "if(NOT ${code} EQUAL 0)\nmessage(FATAL_ERROR ${said})\nendif()\n"
        "install(FILES a.yaml DESTINATION share/pkg)\n",
        ("a.yaml",),
    )
    assert paths(script) == {"share/pkg/a.yaml": False}
    assert not hidden(script)


def test_an_error_on_each_remaining_path_hides_everything() -> None:
    stopped = run("find_package(x)\nif(NOT x_FOUND)\nreturn()\nendif()\nmessage(FATAL_ERROR no)\nadd_executable(a a.cpp)\n")
    assert hidden(stopped) & Facet.EXECUTABLES


def test_an_undefined_target_hides_nothing_else() -> None:
    script = run("add_executable(a a.cpp)\ninstall(TARGETS a b DESTINATION lib/pkg)\n", ("a.cpp",))
    assert paths(script)["lib/pkg/a"] is False
    assert paths(script)["lib/pkg/b"] is True
    assert not hidden(script)
    assert [problem.kind for problem in script.problems] == ["undefined-target"]
    script = run("find_package(x)\nx_make(b)\ninstall(TARGETS b DESTINATION lib/pkg)\n")
    assert hidden(script) & Facet.EXECUTABLES


def test_empty_lists_install_nothing() -> None:
    script = run("install(TARGETS ${none} DESTINATION lib)\ninstall(DIRECTORY ${none} DESTINATION share/pkg)\n")
    assert paths(script).keys() <= {"share/pkg/package.xml"}
    assert not hidden(script)
    assert not script.problems


def test_properties_set_in_a_branch_apply_to_the_target_of_that_branch() -> None:
    branch = "add_library(a SHARED a.cpp)\nset_target_properties(a PROPERTIES VERSION 1.2)\ninstall(TARGETS a DESTINATION lib)\n"
    script = run(f"find_package(x)\nif(x_FOUND)\n{branch}endif()\n", ("a.cpp",))
    assert paths(script) == {"lib/liba.so": True, "lib/liba.so.1.2": True}


@pytest.mark.parametrize("place", ["${WHERE}", '"${WHERE}"', "share/${WHERE}"])
def test_a_destination_that_differs_between_branches_is_unknown(place: str) -> None:
    either = "set(WHERE a)\nif($ENV{OTHER})\nset(WHERE b)\nendif()\n"
    script = run(f"{either}install(FILES a.h DESTINATION {place})\n", ("a.h",))
    assert not paths(script)
    assert hidden(script)


@pytest.mark.parametrize(
    ("branch", "headers"),
    [
        ('option(SCOPED "" OFF)\nif(SCOPED)\n{}endif()\n', {"include/a.h": False}),
        ('option(SCOPED "" ON)\nif(SCOPED)\n{}endif()\n', {"include/pkg/a.h": False}),
    ],
)
def test_variables_of_cmake_keep_their_value_if_a_branch_does_not_run(branch: str, headers: dict[str, bool]) -> None:
    scoped = 'set(CMAKE_INSTALL_INCLUDEDIR "${CMAKE_INSTALL_INCLUDEDIR}/pkg")\n'
    script = run(branch.format(scoped) + "install(FILES a.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})\n", ("a.h",))
    assert paths(script) == headers


@pytest.mark.parametrize(
    ("commands", "libraries"),
    [
        ("", {"lib/liba.a": False}),
        ("set(BUILD_SHARED_LIBS ON)\n", {"lib/liba.so": False}),
        ("unheard_of()\n", {"lib/liba.so": True, "lib/liba.a": True}),
    ],
)
def test_build_shared_libs_decides_the_type_of_a_library(commands: str, libraries: dict[str, bool]) -> None:
    assert paths(run(f"{commands}add_library(a a.cpp)\ninstall(TARGETS a)\n", ("a.cpp",))) == libraries


def test_pybind11_modules_are_python_packages() -> None:
    text = "pybind11_add_module(_core core.cpp)\ninstall(TARGETS _core DESTINATION ${PYTHON_INSTALL_DIR}/pkg)\n"
    script = run(text, ("core.cpp",))
    assert paths(script) == {"lib/python/site-packages/pkg/_core.so": False}
    assert script.products.python_packages == ("pkg._core",)
    assert not hidden(script)


def test_an_unknown_python_version_still_installs_modules() -> None:
    place = "lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/site-packages"
    script = run(f"find_package(Python3 REQUIRED)\ninstall(DIRECTORY imp/ DESTINATION {place}/)\n", ("imp/joints.py",))
    assert paths(script) == {"lib/python/site-packages/joints.py": False}
    assert not hidden(script)
    elsewhere = "install(FILES a.py DESTINATION lib/python${Python3_VERSION_MAJOR})\n"
    assert hidden(run(f"find_package(Python3 REQUIRED)\n{elsewhere}", ("a.py",)))


def test_unlisted_folders_are_installed() -> None:
    text = HEAD + "install(DIRECTORY share/ DESTINATION share/pkg)\n"
    listed = {"share/build": ["share/build/a.txt", "share/build/b/c.txt"], "gone": []}
    package = sources(text, ("share/a",), unlisted_folders=("share/build", "gone"), list_unlisted=lambda folder: listed[folder])
    script = evaluate(package)
    assert paths(script) == {"share/pkg/a": False, "share/pkg/build/a.txt": False, "share/pkg/build/b/c.txt": False}
    assert not hidden(script)
    script = evaluate(package._replace(list_unlisted=lambda folder: ()))
    assert hidden(script) & Facet.SHARE


def test_keywords_of_install_targets_are_rejected_in_install_directory() -> None:
    text = "install(DIRECTORY launch ARCHIVE DESTINATION lib LIBRARY DESTINATION lib)\n"
    (problem,) = run(text, ("launch/a.launch.py",)).problems
    assert problem.message == "install(DIRECTORY) does not accept 'ARCHIVE', which belongs to install(TARGETS)"
    assert problem.span.column == len("install(DIRECTORY launch ") + 1


def test_configured_files_are_installed_with_their_folder() -> None:
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


def test_many_possible_returns_count_each_command_once() -> None:
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
def test_texts_that_double_in_each_round_become_unknown(line: str) -> None:
    script = run(f'set(L "a;a")\nforeach(i RANGE 60)\n{line}\nendforeach()\ninstall(FILES ${{L}} DESTINATION share/pkg)\n')
    assert hidden(script) & Facet.SHARE


def test_a_long_list_joined_with_a_long_text_becomes_unknown() -> None:
    text = 'set(L "a;a")\nforeach(i RANGE 17)\nset(L ${L} ${L})\nendforeach()\nlist(JOIN L "${L}" L)\n'
    script = run(text + "install(FILES ${L} DESTINATION share/pkg)\n")
    assert hidden(script) & Facet.SHARE


@pytest.mark.parametrize(
    ("body", "too_large"),
    [
        ("set(a ${i})\nset(b ${i})", False),
        ("list(APPEND l ${i}.launch.py)\nlist(LENGTH l n)", True),  # each round costs more than the previous one
    ],
)
def test_commands_on_long_lists_cost_more(body: str, too_large: bool) -> None:
    script = run(f"foreach(i RANGE 20000)\n{body}\nendforeach()")
    assert [opaque.reason for opaque in script.opaque] == ["the script is too large to be evaluated"] * too_large


@pytest.mark.parametrize(
    ("path", "conditional"),
    [
        ("${CMAKE_CURRENT_SOURCE_DIR}/lib/${ARCH}/liba.so", False),  # CMake stops with an error if it does not exist
        ("lib/${ARCH}/liba.so", False),
        ("lib/$ENV{HOME}/libb.so", True),  # no file has this name
        ("${CMAKE_CURRENT_SOURCE_DIR}/lib/${Acme_VERSION}/x86/libb.so", True),
        ("${Acme_DIR}/lib/libb.so", False),
        ("${CMAKE_CURRENT_BINARY_DIR}/libb.so", False),
        ("${CMAKE_CURRENT_BINARY_DIR}/libb.so OPTIONAL", True),
    ],
)
def test_a_file_in_an_unknown_folder_is_conditional_if_no_file_matches(path: str, conditional: bool) -> None:
    arch = "find_package(Acme REQUIRED)\nset(ARCH x86)\nif(CMAKE_SYSTEM_PROCESSOR STREQUAL arm)\nset(ARCH arm)\nendif()\n"
    script = run(f"{arch}install(FILES {path} DESTINATION lib)", ("lib/x86/liba.so", "lib/arm/liba.so"))
    assert list(paths(script).values()) == [conditional]


@pytest.mark.parametrize(
    ("name", "hides"),
    [
        ('ament_index_get_resource(AT at acme)\ninclude("${AT}/acme-version.cmake")', Facet.USES | Facet.EXPORTS),
        ("include(${acme_DIR}/acme-version.cmake)", Facet.USES | Facet.EXPORTS),
        ("include(${acme_DIR}/../more.cmake)", Facet.USES | Facet.EXPORTS),
        ('ament_index_get_resource(AT at acme)\ninclude("${AT}/${UNKNOWN}.cmake")', ALL_FACETS),
        ("include(${CMAKE_CURRENT_BINARY_DIR}/made.cmake)", ALL_FACETS),
        ("include(${acme_FILES}/acme-version.cmake)", ALL_FACETS),
    ],
)
def test_scripts_of_other_packages_hide_only_uses(name: str, hides: Facet) -> None:
    unknown = "if($ENV{X})\nset(UNKNOWN a)\nelse()\nset(UNKNOWN b)\nendif()\n"
    script = run(f"find_package(acme REQUIRED)\n{unknown}{name}\ninstall(FILES package.xml DESTINATION share/pkg)")
    assert hidden(script) == hides
    assert paths(script) == {"share/pkg/package.xml": False}


@pytest.mark.parametrize("regex", ["(x+)+y", "((x|z)*)*y", "(a|x+)+z"])
def test_expressions_of_exponential_time_are_not_evaluated(regex: str) -> None:
    script = run(f'string(REGEX REPLACE "{regex}" "" name "{"x" * 200}")\ninstall(FILES ${{name}} DESTINATION share/pkg)')
    assert hidden(script) == Facet.SHARE
