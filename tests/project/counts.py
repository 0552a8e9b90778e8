#!/usr/bin/env python3
"""How large the tree is and how far one has to read in it: counts.py [ROOT].

Prints a table in Markdown. What is counted and why: docs/architecture.md, "How large it may be".
"""

import pathlib
import re
import sys

CODE = {".cpp", ".hpp", ".inl"}
TINY = 30  # lines
LONGEST_FUNCTION = 40  # lines
# Where one begins to read who asks what becomes of a depth frame, or of a cloud, on its way to a
# force, and the floors that it does not pass.
FRAME = ("src/sensor/stream.cpp", "src/scene/scene_field.cpp", "src/contact/proxy.cpp"), {"prepare", "io"}
CLOUD = ("src/prepare/prepare.cpp", "src/scene/scene_field.cpp", "src/contact/proxy.cpp"), {"depth"}


def code_of(root, folders=("include", "src", "apps")):
    return [path for folder in folders for path in sorted((root / folder).rglob("*"))
            if path.suffix in CODE]


def included(path):
    return re.findall(r'^#include "([^"]+)"', path.read_text(encoding="utf-8"), re.M)


def opened(root, starts, skipped):
    """Files that one opens from `starts`: what is included, and of each header its source."""
    seen, todo = set(), [root / start for start in starts]
    while todo:
        path = todo.pop()
        if path in seen or not path.is_file() or skipped & set(path.relative_to(root).parts):
            continue
        seen.add(path)
        for name in included(path):
            todo += [root / "include" / name, root / "src" / name]
        if path.suffix == ".hpp":
            name = path.relative_to(root).as_posix()
            source = name.replace("include/palpate/", "src/").replace(".hpp", ".cpp")
            todo.append(root / source)
    return seen


def functions(path):
    """(name, line, lines) of the functions of a formatted file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    for begin, line in enumerate(lines):
        if not re.search(r"(\)|const|noexcept|override)( noexcept| override| const)* \{$", line):
            continue
        first = begin
        while first > 0 and (sum(text.count("(") - text.count(")") for text in lines[first:begin + 1]) < 0
                             or lines[first].lstrip().startswith(":")):
            first -= 1  # a head of several lines
        indent = re.match(r" *", lines[first])[0]
        if len(indent) > 2 or re.match(r" *(if|for|while|switch|else|do|\}|namespace)\b", lines[first]):
            continue
        end = next((i for i in range(begin + 1, len(lines)) if lines[i].startswith(indent + "}")), None)
        if end is not None:
            yield lines[first].strip(), first + 1, end - first + 1


def types(path):
    """Names of the types that a header defines at namespace level."""
    return re.findall(r"^(?:class|struct|enum class|enum|using) (\w+)[^;]*?(?:\{| =)",
                      path.read_text(encoding="utf-8"), re.M)


def table(root):
    code = code_of(root)
    lines = {path: path.read_text(encoding="utf-8").count("\n") for path in code}
    yield "lines of include, src and apps", sum(lines.values())
    yield "files of the same", len(code)
    yield f"files of {TINY} lines or less", sum(count <= TINY for count in lines.values())
    yield "public headers", len(code_of(root, ("include",)))
    yield "public types", sum(len(types(path)) for path in code_of(root, ("include",)))
    yield "files from a depth frame to a force", len(opened(root, *FRAME))
    yield "files from a cloud to a force", len(opened(root, *CLOUD))
    yield (f"functions above {LONGEST_FUNCTION} lines",
           sum(length > LONGEST_FUNCTION for path in code for _, _, length in functions(path)))


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    print("| | |\n|---|---|")
    for what, count in table(root):
        print(f"| {what} | {count} |")


if __name__ == "__main__":
    main()
