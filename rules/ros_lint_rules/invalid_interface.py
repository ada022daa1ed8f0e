"""
## What it finds

Messages, services and actions passed to `rosidl_generate_interfaces()` that rosidl rejects:

- types that do not exist: `float`, `int`, `time`, `std_msgs/msg/Header` instead of `std_msgs/Header`, and names of messages
  that do not begin with a capital letter;
- names of fields that are not in lower case with single underscores, and names of constants that are not in upper case;
- duplicate names, and fields named like a C++ keyword;
- lines with a `;`, comments with `//`, lines that begin with spaces, default values that the type does not allow;
- services without a line `---`, actions without two such lines, and lines with `---` and other text;
- files that are not named like `MotorState.msg`, are not in UTF-8, or begin with a byte order mark;
- names of packages with interfaces that have upper-case letters or two underscores in a row.

## Why it matters

The build stops while CMake configures, with a Python traceback from `rosidl_adapter`. Fields named like a C++ keyword fail
later, when the generated code is compiled.

## How to fix it

Follow the message. There is a fix if only one correction is possible.

## Limitations

Not reported:

- Files from which no interfaces are generated, or not in every build.
- Interfaces in IDL.
- More than 100 errors of a file. rosidl itself stops at the first one.
- Files with line endings other than those of Unix and Windows.

Unknown messages of a package are reported by `ungenerated-interface`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Edit, Finding, Fix, Package, Rule, Severity, Workspace, build, names


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    sources = build.generated_from(package)
    # A folder with its own project() generates under the name of that project.
    own = any(p.source in sources and p.path.startswith(f"share/{package.name}/") for p in package.built.products.installs)
    if own and package.manifest and not names.interfaces.is_field(package.name):
        yield Finding(
            f"rosidl cannot generate interfaces for the package name '{package.name}'; "
            "use lower-case letters, digits and single underscores",
            package.manifest.name_span,
            package.name,
        )
    for file in package.interface_files:
        path = package.relative(file.path)
        for problem in file.problems if path in sources else ():
            fix = None
            if problem.instead is not None:
                title = f"write '{problem.instead}'" if problem.instead else "remove the characters that rosidl rejects"
                fix = Fix(title, (Edit(problem.span, problem.instead),))
            yield Finding(problem.message, problem.span, path, fix=fix)


RULE = Rule(
    name="invalid-interface",
    code="ROS314",
    summary="interface files are valid for rosidl",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
