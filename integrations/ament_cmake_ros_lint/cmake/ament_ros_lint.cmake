#
# Add a test that checks the package with ros-lint.
#
# :param TESTNAME: the name of the test, default: "ros_lint"
# :type TESTNAME: string
# :param TIMEOUT: the seconds after which the test fails, default: 300
# :type TIMEOUT: integer
# :param ARGN: options of ros-lint, such as "--pedantic"
# :type ARGN: list of strings
#
# @public
#
function(ament_ros_lint)
  cmake_parse_arguments(ARG "" "TESTNAME;TIMEOUT" "" ${ARGN})
  if(NOT ARG_TESTNAME)
    set(ARG_TESTNAME "ros_lint")
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()

  find_program(ament_ros_lint_BIN NAMES "ament_ros_lint")
  if(NOT ament_ros_lint_BIN)
    message(FATAL_ERROR "ament_ros_lint() could not find program 'ament_ros_lint'")
  endif()

  set(result_file "${AMENT_TEST_RESULTS_DIR}/${PROJECT_NAME}/${ARG_TESTNAME}.xunit.xml")
  set(cmd "${ament_ros_lint_BIN}" "--xunit-file" "${result_file}" ${ARG_UNPARSED_ARGUMENTS})

  file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/ament_ros_lint")
  ament_add_test(
    "${ARG_TESTNAME}"
    COMMAND ${cmd}
    TIMEOUT "${ARG_TIMEOUT}"
    OUTPUT_FILE "${CMAKE_BINARY_DIR}/ament_ros_lint/${ARG_TESTNAME}.txt"
    RESULT_FILE "${result_file}"
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
  )
  set_tests_properties(
    "${ARG_TESTNAME}"
    PROPERTIES
    LABELS "ros_lint;linter"
  )
endfunction()
