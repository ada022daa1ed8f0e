"""
## What it finds

A package that generates interfaces and also installs a Python package with its own name.

## Why it matters

`rosidl_generate_interfaces()` installs a Python package with the name of the package, which contains the generated messages.
CMake stops: "a Python module file or package with the same name 'x' has been installed before". Or one Python package hides the
other one, and `from x.msg import ...` or `from x import ...` fails.

## How to fix it

Rename the Python package, or move the interfaces into a separate package named `x_interfaces` or `x_msgs`.

## Limitations

Not reported:

- Packages that call `rosidl_generate_interfaces()` or `ament_python_install_package()` under a condition.
- Names that cannot be evaluated.
- Interfaces with `SKIP_INSTALL`, because they are not installed.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Related, Rule, Severity, Workspace, build


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    if package.builds_with != "ament_cmake":
        return
    generating = [
        call for call in package.calls("rosidl_generate_interfaces") if not call.blocks and "SKIP_INSTALL" not in call.texts
    ]
    for call in package.calls("ament_python_install_package"):
        name = build.evaluated_name(package, call.texts[0]) if call.args else None
        if generating and not call.blocks and name == package.name:
            yield Finding(
                f"the Python package '{name}' has the same name as the package generated for the interfaces, "
                "so Python finds only one of them; rename this Python package",
                call.span(0),
                name,
                (Related(f"the Python package '{name}' for the interfaces is generated here", generating[0].name_span),),
            )


RULE = Rule(
    name="shadowed-python-package",
    code="ROS311",
    summary="generated interfaces and Python packages have different names",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    package=check,
)
