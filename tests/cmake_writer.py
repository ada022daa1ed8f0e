"""Scripts of CMake made at random."""

from __future__ import annotations

import random
from typing import NamedTuple

VARIABLES = ("A", "B", "C", "D", "L", "M", "CMAKE_MATCH_0", "CMAKE_MATCH_1", "CMAKE_MATCH_COUNT")
UNKNOWN = ("U0", "U1", "U2")
CONCRETE = ("", "0", "ON", "a", "b;c", "x;", "OFF", "7", "a;b;c")


class Script(NamedTuple):
    text: str
    concrete: tuple[str, ...]


class _Writer:
    """Makes a script, a statement at a time."""

    def __init__(self, choice: random.Random) -> None:
        self.choice = choice
        self.lines: list[str] = []
        self.procedures: list[tuple[str, int]] = []
        self.traces = 0
        self.depth = 0
        self.loops = 0
        self.inside = ""

    def pick(self, *options: str) -> str:
        return self.choice.choice(options)

    def name(self) -> str:
        return self.pick("A", "B", "C", "D", "L", "M")

    def readable(self) -> str:
        names = ["A", "B", "C", "D", "L", "M", "L", "M", "U0", "U1", "U2", "NONE", "CMAKE_MATCH_1"]
        if self.inside:
            names += ["ARGN", "ARGV", "ARGC", "ARGV0", "ARGV1", "p", "q", "p", "q", "K_ONE", "K_MANY", "K_FLAG"]
        if self.loops:
            names += ["i", "i"]
        return self.choice.choice(names)

    def text(self) -> str:
        return self.pick(
            "a", "b", "c", "abc", "x1", "0", "1", "7", "-2", "ON", "off", "", "a;b", "b;c;a", ";", "a;", "NOTFOUND",
            "x-NOTFOUND", "src/a.cpp", "1.10", "1.9.0", "ARGN", "A", "B", "hello world", "a\\;b", "[x;y]", "é", "p.q",
            "0x10", "TRUE", "ONE", "FLAG", "MANY",
        )  # fmt: skip

    def word(self) -> str:
        """An argument."""
        roll = self.choice.random()
        if roll < 0.30:
            return self.pick("a", "b", "c", "abc", "x1", "0", "1", "7", "ON", "OFF", "a;b", "src/a.cpp", "A", "B", "1.10")
        if roll < 0.45:
            return '"' + self.text().replace("\\", "\\\\" if self.choice.random() < 0.3 else "\\") + '"'
        if roll < 0.70:
            return f"${{{self.readable()}}}"
        if roll < 0.86:
            return f'"${{{self.readable()}}}"'
        if roll < 0.95:
            parts = [self.pick("a", "b/", "-", "${" + self.readable() + "}", "${" + self.readable() + "}", ".") for _ in "12"]
            body = "".join(parts)
            return self.pick(body, f'"{body}"', f'"{body};z"')
        return self.pick("[[${A};x]]", '"\\${A}"', "a\\;b", '"a\\tb"', "${${A}}", "[=[]]]=]", '"a\\\nb"', "$", "@A@")

    def some(self, low: int, high: int) -> str:
        return " ".join(self.word() for _ in range(self.choice.randint(low, high)))

    def quoted(self) -> str:
        """An argument that is exactly one."""
        return self.pick(
            f'"{self.text()}"'.replace("\\;", ";"), f'"${{{self.readable()}}}"', f'"${{{self.readable()}}}"',
            f'"${{{self.readable()}}}x"', "a", "abc", "b",
        )  # fmt: skip

    def condition(self, depth: int = 0) -> str:
        roll = self.choice.random()
        if depth < 2 and roll < 0.25:
            left, right = self.condition(depth + 1), self.condition(depth + 1)
            return self.pick(f"{left} AND {right}", f"{left} OR {right}", f"({left}) AND ({right})", f"({left} OR {right})")
        if depth < 3 and roll < 0.35:
            return f"NOT {self.condition(3)}"
        if roll < 0.5:
            return self.pick(self.readable(), self.quoted(), f"DEFINED {self.readable()}", "ON", "0", f'"${{{self.readable()}}}"')
        if roll < 0.72:
            operator = self.pick("STREQUAL", "STREQUAL", "STREQUAL", "STRLESS", "STRGREATER_EQUAL")
            return f"{self.quoted()} {operator} {self.quoted()}"
        if roll < 0.82:
            return f"{self.quoted()} {self.pick('EQUAL', 'LESS', 'GREATER_EQUAL', 'GREATER', 'LESS_EQUAL')} {self.quoted()}"
        if roll < 0.88:
            operator = self.pick("VERSION_LESS", "VERSION_EQUAL", "VERSION_GREATER_EQUAL", "VERSION_GREATER")
            return f"{self.quoted()} {operator} {self.quoted()}"
        if roll < 0.95:
            return f"{self.quoted()} IN_LIST {self.name()}"
        regex = self.pick("^a", "b$", "[ab]+", '"(a)(b)?"', "x.*", "^$")
        return f"{self.quoted()} MATCHES {regex}"

    def statement(self) -> None:
        self.depth += 1
        roll = self.choice.random()
        if roll < 0.09:
            self.traces += 1
            self.lines.append(f"trace({self.traces})")
        elif roll < 0.27:
            self.set()
        elif roll < 0.45:
            self.list()
        elif roll < 0.62:
            self.string()
        elif roll < 0.66:
            self.math()
        elif self.depth > 4:
            self.set()
        elif roll < 0.79:
            self.if_()
        elif roll < 0.89 and self.loops < 2:
            self.loop()
        elif roll < 0.94 and not self.inside and not self.loops and (self.depth == 1 or self.procedures):
            self.define()
        elif self.procedures and self.loops < 2 and not self.inside:
            name, _ = self.choice.choice(self.procedures)
            self.lines.append(f"{name}({self.some(2, 5)})")
        else:
            self.set()
        self.depth -= 1

    def body(self, low: int = 1, high: int = 4) -> None:
        for _ in range(self.choice.randint(low, high)):
            self.statement()

    def set(self) -> None:
        name = self.name()
        self.lines.append(
            self.pick(
                f"set({name} {self.some(0, 3)})", f"set({name} {self.some(1, 3)})", f"set({name} {self.some(1, 3)})",
                f"set({name} ${{{name}}} {self.word()})", f'set({name} "${{{name}}};{self.pick("a", "b")}")',
                f"unset({name})", f'option({name} "" {self.pick("ON", "OFF", "")})',
                f'set({name} {self.word()} CACHE {self.pick("STRING", "INTERNAL")} ""{self.pick("", " FORCE")})',
                f"set({name} {self.some(1, 2)} PARENT_SCOPE)" if self.inside == "function" else f"set({name} {self.word()})",
                f"get_filename_component({name} {self.quoted()} {self.pick('NAME', 'NAME_WE', 'EXT', 'DIRECTORY', 'LAST_EXT')})",
            )
        )  # fmt: skip

    def list(self) -> None:
        name, out, word = self.pick("L", "M", "L", "A"), self.name(), self.quoted()
        number = self.pick("0", "1", "-1", "2")
        self.lines.append(
            self.pick(
                f"list(APPEND {name} {self.some(0, 3)})", f"list(APPEND {name} {self.some(1, 3)})",
                f"list(PREPEND {name} {self.some(1, 2)})", f"list(LENGTH {name} {out})",
                f"list(FIND {name} {word} {out})", f"list(REMOVE_ITEM {name} {self.some(1, 2)})",
                f"list(REMOVE_DUPLICATES {name})" , f"list(REVERSE {name})", f"list(SORT {name})",
                f"list(SORT {name} ORDER DESCENDING)", f"list(JOIN {name} {word} {out})",
                f"list(FILTER {name} {self.pick('INCLUDE', 'EXCLUDE')} REGEX {self.pick('a', '^b', '[0-9]', '(x|a)$')})",
                f"list(TRANSFORM {name} {self.pick('APPEND', 'PREPEND')} {word})",
                f"list(TRANSFORM {name} {self.pick('TOUPPER', 'STRIP')} OUTPUT_VARIABLE {out})",
                f'list(TRANSFORM {name} REPLACE "a(.?)" "<\\\\1>")',
                f"list(POP_BACK {name} {out})", f"list(POP_FRONT {name} {out} B)", f"list(SUBLIST {name} 0 2 {out})",
                f"if({name})\nlist(GET {name} {self.pick('0', '-1')} {out})\nendif()",
                f"list(INSERT {name} 0 {self.some(1, 2)})",
                f"list(LENGTH {name} n)\nif(n GREATER 2)\nlist(REMOVE_AT {name} {number})\nlist(GET {name} 0 {out})\nendif()",
            )
        )  # fmt: skip

    def string(self) -> None:
        out, text, other = self.name(), self.quoted(), self.quoted()
        regex = self.pick("a", "[a-c]+", "(a)(b*)", "b?c", "x|a", "^a", "c$", "[^a]", "\\\\.", "(.)(.)", "a+;")
        template = self.pick("z", "<\\\\0>", "\\\\1-\\\\2", "")
        self.lines.append(
            self.pick(
                f"string(FIND {text} {self.pick('a', 'b', ';')} {out})", f"string(REPLACE a {other} {out} {text} {other})",
                f"string(REPLACE {self.pick('b', 'ab', '/')} {other} {out} {text})",
                f'string(REGEX MATCH "{regex}" {out} {text})', f'string(REGEX MATCHALL "{regex}" {out} {text})',
                f'string(REGEX REPLACE "{regex}" "{template}" {out} {text})',
                f"string(APPEND {out} {text} {other})", f"string(PREPEND {out} {text})",
                f"string(CONCAT {out} {self.some(1, 3)})",
                f"string(JOIN {text} {out} {self.some(1, 3)})", f"string(TOUPPER {text} {out})", f"string(TOLOWER {text} {out})",
                f"string(LENGTH {text} {out})", f"string(STRIP {text} {out})",
                f"string(REPEAT {text} {self.pick('0', '2')} {out})",
                f"string(COMPARE {self.pick('EQUAL', 'LESS', 'NOTEQUAL')} {text} {other} {out})",
                f"string(MAKE_C_IDENTIFIER {text} {out})", f"string(HEX {text} {out})", f"string(SUBSTRING {text} 0 -1 {out})",
                f'string(GENEX_STRIP "$<A:b>c{self.pick("", "$<x", "$<y:$<z>>")}" {out})', f"string(MD5 {out} {text})",
                f"string(LENGTH {text} n)\nif(n GREATER 1)\nstring(SUBSTRING {text} 1 {self.pick('1', '-1')} {out})\nendif()",
            )
        )  # fmt: skip

    def math(self) -> None:
        numbers = [self.pick("1", "2", "7", "-3", "0x1F", "(4-6)", "10") for _ in "123"]
        first, second = (self.pick("+", "-", "*", "/", "%", "&", "|", "^", "<<") for _ in "12")
        self.lines.append(f'math(EXPR {self.name()} "{numbers[0]} {first} {numbers[1]} {second} {numbers[2].strip("-")}")')
        if self.choice.random() < 0.5:
            self.lines.append(f"list(LENGTH L n)\nmath(EXPR {self.name()} ${{n}}*2+1)")

    def if_(self) -> None:
        self.lines.append(f"if({self.condition()})")
        self.body(0, 3)
        for _ in range(self.choice.choice((0, 0, 1, 2))):
            self.lines.append(f"elseif({self.condition()})")
            self.body(0, 3)
        if self.choice.random() < 0.5:
            self.lines.append("else()")
            self.body(1, 3)
        self.lines.append("endif()")

    def loop(self) -> None:
        self.loops += 1
        if self.choice.random() < 0.2:
            count = f"n{self.loops}"
            limit = self.pick(f"{count} LESS 3", f"NOT {count} EQUAL 2", f"{count} LESS 4 AND {self.condition(2)}")
            self.lines.append(f'set({count} 0)\nwhile({limit})\nmath(EXPR {count} "${{{count}}}+1")')
            self.body(1, 3)
            self.lines.append("endwhile()")
            self.loops -= 1
            return
        self.lines.append(
            self.pick(
                f"foreach(i {self.some(0, 3)})", f"foreach(i IN LISTS L {self.pick('', 'M', 'A')})",
                f"foreach(i IN ITEMS {self.some(0, 3)})", f"foreach(i IN LISTS L ITEMS {self.some(0, 2)})",
                f"foreach(i RANGE {self.pick('2', '1 3', '5 0 -2', '0 6 3')})", "foreach(i IN ZIP_LISTS L M)",
            )
        )  # fmt: skip
        self.body(1, 3)
        if self.choice.random() < 0.4:
            self.lines.append(f"if({self.condition()})\n{self.pick('break', 'continue')}()\nendif()")
            self.body(0, 2)
        self.lines.append("endforeach()")
        self.loops -= 1

    def define(self) -> None:
        kind = self.pick("function", "macro")
        name = f"f{len(self.procedures)}"
        if self.depth > 1 or (self.procedures and self.choice.random() < 0.2):
            name = self.choice.choice(self.procedures)[0]
        self.lines.append(f"{kind}({name} p q)")
        self.inside = kind
        if self.choice.random() < 0.5:
            multi = self.pick('"${ARGN}"', "${ARGN}")
            form = self.pick(f"cmake_parse_arguments(K FLAG ONE MANY {multi})", "cmake_parse_arguments(K FLAG ONE MANY ${ARGN})")
            if kind == "function" and self.choice.random() < 0.3:
                form = 'cmake_parse_arguments(PARSE_ARGV 1 K "FLAG" "ONE" "MANY")'
            self.lines.append(form)
            self.lines.append('set(A "${K_FLAG}|${K_ONE}|${K_MANY}|${K_UNPARSED_ARGUMENTS}|${K_KEYWORDS_MISSING_VALUES}")')
            self.lines.append(self.pick("set(B ${K_MANY} PARENT_SCOPE)", "if(DEFINED K_ONE)\nset(B one)\nendif()"))
        self.body(1, 4)
        if self.choice.random() < 0.4 and kind == "function":
            self.lines.append(f"if({self.condition()})\nreturn()\nendif()")
            self.body(1, 3)
        self.lines.append(f"set({self.name()} ${{A}} ${{p}} PARENT_SCOPE)" if kind == "function" else "trace(m)")
        self.inside = ""
        self.lines.append(f"end{kind}()")
        if (name, 2) not in self.procedures:
            self.procedures.append((name, 2))


def generate(seed: int) -> Script:
    choice = random.Random(seed)
    writer = _Writer(choice)
    writer.body(6, 16)
    concrete = tuple(choice.choice(CONCRETE) for _ in UNKNOWN)
    return Script("\n".join(writer.lines), concrete)
