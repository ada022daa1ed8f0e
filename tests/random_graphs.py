"""Random manifests that need each other by every tag, group and condition, as text."""

from __future__ import annotations

from random import Random

from tests.packages import manifest_text

TAGS = (
    "depend",
    "build_depend",
    "buildtool_depend",
    "build_export_depend",
    "buildtool_export_depend",
    "exec_depend",
    "test_depend",
    "doc_depend",
    "conflict",
    "replace",
)
CONDITIONS = ("", "", "", "", "$ROS_VERSION == 2", "$ROS_VERSION == 1", "$ROS_DISTRO >= humble and $ROS_VERSION != 1")
GROUPS = ("g1", "g2")


def manifests(random: Random) -> dict[str, str]:
    """Return manifests by name, about half of them in workspaces with a cycle."""
    names = [f"{random.choice('abcxyz')}{number}" for number in range(random.choice((2, 3, 4, 6, 9, 15)))]
    random.shuffle(names)
    density = random.choice((0.5, 0.9, 1.3))
    lines: dict[str, list[str]] = {name: [] for name in names}
    for _ in range(int(len(names) * density) + 1):
        first, second = random.sample(range(len(names)), 2)
        if random.random() < 0.6:  # mostly in one direction
            first, second = max(first, second), min(first, second)
        tag = random.choice(TAGS)
        others = [line for line in lines[names[first]] if f">{names[second]}<" in line]
        if (tag == "depend" and others) or any(line.startswith("<depend") for line in others):
            continue  # which may be redundant, and then the manifest is rejected
        lines[names[first]].append(_depend(random, tag, names[second]))
    for name in names:
        if random.random() < 0.3:
            lines[name].append(_depend(random, "depend", random.choice(("rclcpp", "not_here"))))
        for group in random.sample(GROUPS, random.choice((0, 0, 0, 1, 2))):
            lines[name].append(_depend(random, random.choice(("group_depend", "member_of_group")), group))
    return {name: manifest_text(name, dict.fromkeys(found)) for name, found in lines.items()}


def _depend(random: Random, tag: str, name: str) -> str:
    condition = random.choice(CONDITIONS)
    return f"<{tag}{f' condition={chr(34)}{_escaped(condition)}{chr(34)}' if condition else ''}>{name}</{tag}>"


def _escaped(condition: str) -> str:
    return condition.replace(">", "&gt;")
