"""Run ros-lint for one package and write the result as an xunit file, as the linters of ament do."""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

PROGRAM = "ros-lint"
FAILED = 2
"""The exit code of ros-lint if the check could not be done."""


def main(argv=None):
    """Check packages, print the findings and return the exit code of ros-lint.

    ``argv`` contains ``--xunit-file FILE``, paths (default: the current folder) and options of ros-lint.
    """
    code, findings = main_with_findings(argv)
    for finding in findings:
        print(finding)
    return code


def main_with_findings(argv=None):
    """Check packages as :func:`main` does, and return the exit code and the findings instead of printing them."""
    parser = argparse.ArgumentParser(
        description="Check ROS 2 packages with ros-lint.",
        epilog="All other arguments are paths and options of ros-lint.",
        allow_abbrev=False,
    )
    parser.add_argument("--xunit-file", metavar="FILE", help="write the result to this file")
    options, others = parser.parse_known_args(argv)
    if options.xunit_file:
        os.makedirs(os.path.dirname(os.path.abspath(options.xunit_file)), exist_ok=True)
        return _check(others, options.xunit_file)
    with tempfile.TemporaryDirectory() as folder:
        return _check(others, os.path.join(folder, "ros_lint.xunit.xml"))


def run():
    """Run the command ``ament_ros_lint``."""
    sys.exit(main())


def _check(arguments, xunit_file):
    program = shutil.which(PROGRAM)
    if program is None:
        return FAILED, [f"the program '{PROGRAM}' is not installed, or not in PATH"]
    # An earlier file must not be taken for the result of this run.
    if os.path.exists(xunit_file):
        os.remove(xunit_file)
    command = [program, *arguments, "--format", "junit", "--output", xunit_file]
    code = subprocess.call(command)
    return code, _findings(xunit_file) if os.path.exists(xunit_file) else []


def _findings(xunit_file):
    """Return the lines of the failures and errors in an xunit file."""
    cases = ElementTree.parse(xunit_file).getroot().iter("testcase")
    problems = [problem for case in cases for problem in case if problem.tag in ("failure", "error")]
    texts = (problem.text or problem.get("message", "") for problem in problems)
    return [line for text in texts for line in text.strip().splitlines()]
