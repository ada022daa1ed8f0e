"""Arguments with keywords, as cmake_parse_arguments() and most commands take them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from ros_lint.interpret.cmake_values import HOLE, MAYBE, join, split


def parse_keywords(prefix: str, options: str, ones: str, multis: str, args: Sequence[str]) -> dict[str, str | None]:
    """Return the variables that cmake_parse_arguments() sets; None unsets one."""
    flags, singles, lists = split(options), split(ones), split(multis)
    values: dict[str, str | None] = {f"{prefix}_{name}": "FALSE" for name in flags}
    values.update({f"{prefix}_{name}": None for name in (*singles, *lists)})
    found: dict[str, list[str]] = {name: [] for name in lists}
    given: dict[str, None] = {}
    unparsed: list[str] = []
    state = ""
    kind = ""
    for arg in args:
        if arg in flags:
            values[f"{prefix}_{arg}"] = "TRUE"
            kind = ""
        elif arg in singles:
            state, kind = arg, "single"
            given[arg] = None
        elif arg in found:
            state, kind = arg, "list"
            given[arg] = None
        elif kind == "single":
            values[f"{prefix}_{state}"] = arg
            kind = "maybe" if arg == HOLE or arg.startswith(MAYBE) else ""
        elif kind == "maybe" and arg.startswith(MAYBE):
            values[f"{prefix}_{state}"] = HOLE
        elif kind == "list":
            found[state].append(arg)
        else:
            kind = ""
            unparsed.append(arg)
        if arg.startswith(MAYBE) and (arg[1:] in flags or arg[1:] in singles or arg[1:] in found):
            values.update(dict.fromkeys(values, HOLE))
            return values
    values.update({f"{prefix}_{name}": join(items) if name in given else None for name, items in found.items()})
    missing = [name for name in given if name in found and not found[name]]
    missing += [name for name in given if name in singles and values[f"{prefix}_{name}"] is None]
    values[f"{prefix}_UNPARSED_ARGUMENTS"] = join(unparsed) if unparsed else None
    values[f"{prefix}_KEYWORDS_MISSING_VALUES"] = join(missing) if missing else None
    return values


def sections(args: Iterable[str], keywords: Mapping[str, int]) -> dict[str, list[str]]:
    """Return arguments by the keyword before them; those before the first keyword under "".

    ``keywords`` gives how many arguments a keyword takes, -1 for any number. What follows when it has enough belongs to "".
    """
    found: dict[str, list[str]] = {"": []}
    current, room = "", -1
    for arg in args:
        wanted = keywords.get(arg)
        if wanted is not None:
            current, room = arg, wanted
            found.setdefault(arg, [])
            if not room:
                current, room = "", -1
        else:
            if not room:
                current, room = "", -1
            found.setdefault(current, []).append(arg)
            room -= room > 0
    return found
