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
# force, and the floors that it does not pass. The core is what is left of a cloud's way without refinements.
FIELD = ("src/scene/scene_field.cpp", "src/contact/proxy.cpp")
FRAME = ("src/sensor/stream.cpp", "src/stream/source_frames.cpp", *FIELD), {"prepare", "refine", "io"}
CLOUD = ("src/large/prepare_cloud.cpp", "src/refine/refinements.cpp", *FIELD), {"depth"}
CORE = ("src/prepare/prepare.cpp", *FIELD), {"depth"}


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


HEART = ("prepare", "refine", "field", "scene", "stream", "sight", "large", "depth", "contact", "geometry", "tool")  # between a cloud and a force
MOST_METHODS, MOST_MEMBERS = 20, 12  # of a class, where its reader still knows the first at the last
# What a sentence does not begin with: each leaves out who does what.
RIDDLE = re.compile(r"\s*//[/!]?<? *(Of|By|As|To be|Those)\b")
AHEAD = re.compile(r"$|#|namespace\b|using\b|\}|(class|struct) \w+;|extern|template <|export")


def sources(root, folders=("include", "src", "apps")):
    return [path for path in code_of(root, folders) if path.suffix == ".cpp"]


def lines_of(path):
    return path.read_text(encoding="utf-8").splitlines()


def has_purpose(path):
    """A source begins with a comment; a header's first line that is no include or the like is one."""
    lines = lines_of(path)
    if path.suffix == ".cpp":
        return lines[0].startswith("//")
    return next((line for line in lines if not AHEAD.match(line)), "//").startswith("//")


def riddles(path):
    """Numbers of the lines on which a comment begins with what no sentence begins with."""
    lines = lines_of(path)
    return [i + 1 for i, line in enumerate(lines)
            if RIDDLE.match(line) and not (i > 0 and lines[i - 1].lstrip().startswith("//"))]


def constants(path):
    """(name, line, has it a reason: a comment beside it or above it) of named constants."""
    lines = lines_of(path)
    for i, line in enumerate(lines):
        found = re.search(r"\bconst(?:expr|init)?\b[^=({]*\b(k[A-Z]\w*)(?:\[\w*\])? *(?:=|\{)", line)
        if not found:
            continue
        end = next((j for j in range(i, len(lines)) if ";" in lines[j].split("//")[0]), i)
        told = "//" in line or "//" in lines[end] or lines[i - 1].lstrip().startswith("//")
        yield found[1], i + 1, told


TYPE = re.compile(r"( *)(class|struct) (?:\w+::)*(\w+)[^;(]*\{$")
NO_MEMBER = re.compile(r"(using|friend|static|static_assert|enum|struct|class|template|public|private|protected)\b")
UNCHANGING = r"(explicit |constexpr )*{}\(|static |.*\boperator([=!<>]=|[<>])\(|.*\) const\b"


def heads_of(body, indent):
    """The beginnings of what a class declares, each in one line, without what stands between < and >."""
    for i, line in enumerate(body):
        if re.match(indent + r"  [\w\[~]", line):
            end = next((j for j in range(i, len(body)) if re.search(r"[;:{}]$", body[j])), i)
            head = re.sub(r"\[\[\w+\]\] ", "", " ".join(part.strip() for part in body[i:end + 1]))
            yield re.sub(r"<[^<>;]*>", "", re.sub(r"<[^<>;]*>", "", head))


def classes(path):
    """(name, line, methods, members) of a file's classes, and of its structs but plain ones: a plain struct has no
    methods but constructors, comparisons, const and static ones."""
    lines = lines_of(path)
    for i, line in enumerate(lines):
        found = TYPE.match(line)
        if not found:
            continue
        indent, kind, name = found.groups()
        end = next(j for j in range(i, len(lines)) if lines[j].startswith(indent + "};"))
        heads = [head for head in heads_of([line.split("//")[0].rstrip() for line in lines[i + 1:end]], indent)
                 if not re.search(r"= (default|delete);$|^(using|friend|static_assert|template)\b", head)]
        methods = [head for head in heads if re.search(r"[\w=\]]\(", re.split(r" = |\{", head)[0])]
        if kind == "class" or not all(re.match(UNCHANGING.format(name), head) for head in methods):
            yield name, i + 1, len(methods), sum(
                head not in methods and not NO_MEMBER.match(head) for head in heads)


ASSERTS = re.compile(r"(EXPECT|ASSERT)_|RC_ASSERT|ADD_FAILURE|FAIL$")


def seen_by(root, path):
    """A test's file and what it includes of the tests, with the sources of these."""
    seen, todo = set(), [path]
    while todo:
        file = todo.pop()
        if file not in seen and file.is_file():
            seen.add(file)
            todo += [file.with_suffix(".cpp"), *(root / "tests" / name for name in included(file))]
    return seen


def unproven(root):
    """(path, line, head) of test cases that assert nothing, neither themselves nor by what they call of the tests."""
    cases, helpers, proving = [], [], {}
    for path in code_of(root, ("tests",)):
        lines = [line.split("//")[0] for line in lines_of(path)]
        seen, proving[path] = seen_by(root, path), set()
        for head, line, length in functions(path):
            name, *calls = re.findall(r"(\w+)(?:<[^;()]*>)?\(", "\n".join(lines[line - 1:line - 1 + length])) or [""]
            kind = cases if re.match(r"(TYPED_)?TEST(_[FP])?\(|RC_GTEST", head) else helpers
            kind.append((path, line, head, seen, name, calls))

    def proves(seen, calls):
        return any(ASSERTS.match(call) or any(call in proving[file] for file in seen) for call in calls)

    known = -1
    while known < sum(map(len, proving.values())):  # until no helper of a helper is new
        known = sum(map(len, proving.values()))
        for path, _, _, seen, name, calls in helpers:
            if proves(seen, calls):
                proving[path].add(name)
    return [(path, line, head) for path, line, head, seen, _, calls in cases if not proves(seen, calls)]


def has_header(root, path):
    """A header of its name: beside it, or a public one."""
    public = root / "include/palpate" / path.relative_to(root / "src").with_suffix(".hpp")
    return path.with_suffix(".hpp").exists() or public.exists()


def words_to_a_force(root):
    """Rows of the glossary."""
    text = (root / "docs/glossary.md").read_text(encoding="utf-8")
    return len(re.findall(r"^\| (?!word |-)", text, re.M))


def house(root):
    """How many ideas one has to carry."""
    heart = [path for path in code_of(root, ("include", "src")) if set(HEART) & set(path.parts)]
    named = [told for path in heart for _, _, told in constants(path)]
    largest = [of for path in code_of(root) for of in classes(path)]
    yield "words of the glossary", words_to_a_force(root)
    yield f"named constants in {', '.join(HEART)}", len(named)
    yield "of these without a reason", named.count(False)
    yield f"classes above {MOST_METHODS} methods or {MOST_MEMBERS} members", sum(
        methods > MOST_METHODS or members > MOST_MEMBERS for _, _, methods, members in largest)
    yield "most methods of a class", max(methods for _, _, methods, _ in largest)
    yield "most members of a class", max(members for _, _, _, members in largest)
    yield "sources of src without a header of their name", sum(
        not has_header(root, path) for path in sources(root, ("src",)))
    yield "files without a sentence of purpose", sum(not has_purpose(path) for path in code_of(root))
    yield "comments that begin with Of, By, As, To be, Those", sum(
        len(riddles(path)) for path in code_of(root, ("include", "src", "apps", "bench", "tests", "python")))


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
    yield "files of the core alone", len(opened(root, *CORE))
    yield (f"functions above {LONGEST_FUNCTION} lines",
           sum(length > LONGEST_FUNCTION for path in code for _, _, length in functions(path)))


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    print("| | |\n|---|---|")
    for what, count in (*table(root), *house(root)):
        print(f"| {what} | {count} |")


if __name__ == "__main__":
    main()
