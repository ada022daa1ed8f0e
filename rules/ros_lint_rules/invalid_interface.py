"""
## What it finds

Definitions of messages, services and actions that are given to `rosidl_generate_interfaces()` and that rosidl does not take:

- types that there are not: `float`, `int`, `time`, `std_msgs/msg/Header` for `std_msgs/Header`, and names of messages that do not
  begin with a capital letter;
- fields that are not in lower case with single underscores, constants that are not in upper case, two of one name, and fields
  that are words of C++;
- a line with a `;`, a comment with `//`, a line that begins with blanks, a default value that the type does not have;
- a service without the line `---`, an action without two of them, and such a line with anything else on it;
- files that are not called like `MotorState.msg`, that are not in UTF-8, or that begin with a byte order mark;
- a package with such files whose name has upper-case letters or two underscores in a row.

## Why it matters

The build stops while CMake configures, with a trace of Python from `rosidl_adapter`. Of fields that are words of C++ the compiler
tells, in generated code.

## How to fix it

Write what the message says. The fix does this where it is sure what has to stand there.

## Limitations

- For files that nothing is generated from, in some build or at all, and for definitions in IDL.
- For files that have line ends of other kinds than those of Unix and Windows.

Messages that a package does not have are told by `ungenerated-interface`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Edit, Finding, Fix, Package, Rule, Severity, Workspace, generated_from, interface_names, relative


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    given = generated_from(package)
    # A folder with a project() of its own generates for that one.
    own = any(p.source in given and p.path.startswith(f"share/{package.name}/") for p in package.built.provides)
    if own and package.manifest and not interface_names.is_field(package.name):
        yield Finding(
            f"rosidl generates nothing for a package called {package.name}: "
            "its name has to have lower-case letters, digits and single underscores",
            package.manifest.name_span,
            package.name,
        )
    for file in package.interface_files:
        path = relative(package, file.path)
        for problem in file.problems if path in given else ():
            fix = None
            if problem.instead is not None:
                title = f"write {problem.instead}" if problem.instead else "take it away"
                fix = Fix(title, (Edit(problem.span, problem.instead),))
            yield Finding(problem.message, problem.span, path, fix=fix)


RULE = Rule(
    name="invalid-interface",
    code="ROS314",
    summary="a definition of an interface must be one that rosidl takes",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
