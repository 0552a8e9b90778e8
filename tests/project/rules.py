#!/usr/bin/env python3
"""The rules of the tree that a compiler does not check: rules.py RULE [ROOT]."""

import pathlib
import re
import sys

import counts

# The core: from a cloud to a force. It sees none of the floors beside it (docs/architecture.md).
CORE = {
    "base": set(),
    "geometry": {"base"},
    "field": {"base", "geometry"},
    "contact": {"base", "geometry"},  # and field/field.hpp: see ALLOWED
    "prepare": {"base", "geometry", "field"},
    "scene": {"base", "geometry", "field", "prepare"},  # and options of the depth filter: see ALLOWED
}
# What each floor may include besides itself: only what lies below it. docs/architecture.md draws it.
FLOORS = CORE | {
    "core_only": {"base", "geometry", "io", "field", "prepare", "scene"},
    "depth": {"base", "geometry"},
    "refine": {"base", "geometry", "field", "prepare"},
    "sight": {"base", "geometry", "depth", "field", "prepare", "scene"},
    "stream": {"base", "geometry", "depth", "field", "prepare", "scene", "sight"},
    "large": {"base", "geometry", "field", "prepare", "refine", "scene"},
    "splats": {"base", "geometry"},
    "io": {"base", "geometry", "depth", "splats"},
    "tile": {"base", "geometry", "io"},
    "message": {"base", "geometry", "depth", "io"},
    "bag": {"base", "geometry", "depth", "io", "message"},
    "dds": {"base", "message"},
    "align": {"base", "geometry", "field"},
    "tool": {"base", "geometry", "field", "contact", "prepare", "scene"},
    "sim": {"base", "geometry", "depth", "io", "field"},  # and the camera that it is: see ALLOWED
    "sensor": {"base", "geometry", "depth", "io", "message", "bag", "dds", "field", "prepare",
               "scene", "sim"},
    "device": {"base", "geometry", "io", "message", "dds", "field", "contact", "prepare", "scene"},
    "servo": {"base", "geometry", "field", "contact", "prepare", "scene", "tool", "device"},
    "viewer": {"base", "geometry", "field", "contact", "prepare", "scene", "sensor", "tool", "device",
               "servo"},
    "session": {"base", "geometry", "io", "depth", "message", "bag", "field", "contact", "prepare", "scene", "tool", "sensor", "device", "servo", "viewer"},
    "tab": {"base", "geometry", "io", "bag", "depth", "field", "contact", "prepare", "scene", "sim", "sensor", "device", "servo", "viewer",
            "session"},
    "ros": {"base", "geometry", "message", "bag", "dds", "field", "contact", "prepare", "scene",
            "sensor", "device", "servo"},
    "apps": {"base", "geometry", "depth", "io", "tile", "message", "bag", "field", "contact", "prepare", "align",
             "scene", "tool", "stream", "sensor", "device", "servo", "ros", "viewer", "session"},
    "python": {"base", "geometry", "depth", "io", "field", "contact", "prepare", "scene", "tool", "sensor", "device", "servo"},
}
# The files of two floors from the first step on: what stands in one line sees what stands above it.
STEPS = {
    "prepare": [{"description", "stopwatch", "point_fits", "places", "height_groups"},
                {"given_normals", "lines", "segment_fit"}, {"place"}, {"noise"}, {"sampling"}, {"limit_radii"},
                {"radii"}, {"plane_fits"}, {"weights"}, {"surfels"}, {"orientation"}, {"assemble"}, {"prepare"}],
    "refine": [{"signed_graph", "holes"}, {"outliers"}, {"gaps"}, {"segments"},
               {"snapping"}, {"grow_segments", "look_around"}, {"second_planes"}, {"refinements"}],
}
# The rooms of the program, from the top down: what stands in one line sees what stands below it.
ROOMS = [{"align", "bag", "devices", "doctor", "info", "paper", "replay", "tile", "touch",
          "zwidth"}, {"view"},
         {"report"}, {"run"}, {"record"}, {"sources"}, {"options"}, {"plot"}, {"cli"}]
# Single headers that a floor may include of a floor that it may not see otherwise.
ALLOWED = {("contact", "palpate/field/field.hpp"), ("sim", "palpate/sensor/depth_camera.hpp"),
           ("scene", "palpate/depth/depth_filter.hpp")}

# What asks what machine it is compiled for, and whether that has threads.
PLATFORM_FILES = {"src/base/cpu.hpp", "src/geometry/parallel.hpp", "tests/support/thread_limit.hpp"}

SOURCE_FOLDERS = ("apps", "bench", "examples", "fuzz", "include", "python", "src", "tests")
TEXT_SUFFIXES = {".cpp", ".hpp", ".inl", ".in", ".cmake", ".md", ".mjs", ".py", ".sh", ".ts", ".txt"}
LONGEST_FILE = 300  # lines
LARGEST_MODULE = 250  # lines of a header and its sources, about


# Floors that read files, and what a message of theirs tells people to type or to write.
REMEDY_FLOORS = ("io", "bag", "sensor", "python", "palpate")
REMEDY = re.compile(r"python3 -c|\bpalpate (?:touch|info|tile|bag|align|replay) |'palpate bag|"
                    r"\b(?:xz|zstd|bunzip2|gunzip|unzip|npx|colmap|pdal|chmod|mcap|rosbags-convert|git lfs|ulimit|modprobe) "
                    r"|(?<!to )\bwrite (?:1|\{\}|\\\"|endsolid|[a-z_]+,)")


def sources(root, folders=SOURCE_FOLDERS):
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in {".cpp", ".hpp", ".inl"}:
                yield path


def lines(path):
    return path.read_text(encoding="utf-8").splitlines()


def floor_of(parts):
    """The floor of a file or an include, given its path below the root or as it is written."""
    if parts[0] in {"include", "src"}:
        parts = parts[1:]
    if parts[0] == "extras":  # each of which is a floor
        parts = parts[1:]
    if parts[0] == "palpate":
        parts = parts[1:]
    return parts[0] if len(parts) > 1 and parts[0] in FLOORS else None


def floors(root):
    """Includes point down the floors only."""
    for path in sources(root, ("include", "src", "apps", "python")):
        name = path.relative_to(root)
        here = name.parts[0] if name.parts[0] in {"apps", "python"} else floor_of(name.parts)
        if here is None:  # palpate.hpp, which gathers
            continue
        for number, line in enumerate(lines(path), 1):
            found = re.match(r'\s*#\s*include\s+["<]([^">]+)[">]', line)
            there = floor_of(pathlib.PurePosixPath(found[1]).parts) if found else None
            if there is None or there == here or (here, found[1]) in ALLOWED:
                continue
            if there not in FLOORS[here]:
                yield f"{name}:{number}: {here} must not include {found[1]} of {there}"


def drawn(root):
    """docs/architecture.md draws every floor, above all that it may include."""
    drawing = (root / "docs" / "architecture.md").read_text(encoding="utf-8").partition("\n## Floors\n")[2].split("```")[1]
    row = {name: number for number, line in enumerate(drawing.splitlines())
           for name in re.findall(r"(?:^|\s)(?:extras/)?(\w+)/\s", line)}
    for floor, below in FLOORS.items():
        if floor not in row:
            yield f"docs/architecture.md: {floor} is not drawn"
        for other in sorted(below & row.keys() if floor in row else ()):
            if row[other] <= row[floor]:
                yield f"docs/architecture.md: {other} is not below {floor}, which may include it"


def steps(root):
    """Includes between the steps of preparation point to earlier ones; no file is without a step."""
    for floor, rows in STEPS.items():
        step_of = {name: number for number, row in enumerate(rows) for name in row}
        for path in sources(root, (f"src/{floor}",)):
            name = path.relative_to(root)
            if path.stem not in step_of:
                yield f"{name}: no step of {floor}; STEPS in tests/project/rules.py lists them"
                continue
            for number, line in enumerate(lines(path), 1):
                found = re.match(rf'\s*#\s*include\s+"{floor}/(\w+)\.hpp"', line)
                if found and found[1] != path.stem and step_of.get(found[1], 99) >= step_of[path.stem]:
                    yield f"{name}:{number}: an earlier step must not include {found[1]}"


def rooms(root):
    """Includes of the program's files point down its rooms; only main.cpp stands in none."""
    height = {room: -depth for depth, row in enumerate(ROOMS) for room in row}
    for path in sources(root, ("apps",)):
        name = path.relative_to(root)
        if name.parts[1:] == ("palpate", "main.cpp"):
            continue
        here = name.parts[2]
        if here not in height:
            yield f"{name}: no room of the program; ROOMS in tests/project/rules.py lists them"
            continue
        for number, line in enumerate(lines(path), 1):
            found = re.match(r'\s*#\s*include\s+"apps/palpate/(\w+)/', line)
            if found and found[1] != here and height.get(found[1], 1) >= height[here]:
                yield f"{name}:{number}: {here} must not include what is in {found[1]}"


def public_headers(root):
    """Public headers show no third party but Eigen, and nothing of src/."""
    for path in sources(root, ("include",)):
        for number, line in enumerate(lines(path), 1):
            found = re.match(r'\s*#\s*include\s+(["<])([^">]+)[">]', line)
            if not found:
                continue
            ours = found[1] == '"' and found[2].startswith("palpate/")
            standard = found[1] == "<" and re.fullmatch(r"[a-z_]+", found[2])
            eigen = found[1] == "<" and found[2].startswith("Eigen/")
            if not (ours or standard or eigen):
                yield f"{path.relative_to(root)}:{number}: {found[2]} in a public header"


def macros(root):
    """No macros; questions about the machine in one file only."""
    for path in sources(root):
        name = path.relative_to(root).as_posix()
        for number, line in enumerate(lines(path), 1):
            if re.match(r"\s*#\s*define\b", line):
                yield f"{name}:{number}: a macro"
            elif re.match(r"\s*#\s*(if|ifdef|ifndef)\b", line) and name not in PLATFORM_FILES:
                yield f"{name}:{number}: conditional compilation outside {PLATFORM_FILES}"


def marks(root):
    """No marks of unfinished work: they belong into issues."""
    mark = re.compile(r"\b(TO" + r"DO|FIX" + r"ME|X" + r"XX|HA" + r"CK)\b")
    for path in sources(root):
        for number, line in enumerate(lines(path), 1):
            if mark.search(line):
                yield f"{path.relative_to(root)}:{number}: {line.strip()}"


def size(root):
    """Files that fit into one head."""
    for path in sources(root):
        count = len(lines(path))
        if count > LONGEST_FILE:
            yield f"{path.relative_to(root)}: {count} lines, more than {LONGEST_FILE}"


def functions(root):
    """Functions that one sees at once."""
    for path in sources(root, ("include", "src", "apps", "python")):
        for head, number, length in counts.functions(path):
            if length > counts.LONGEST_FUNCTION:
                yield (f"{path.relative_to(root)}:{number}: {length} lines, more than "
                       f"{counts.LONGEST_FUNCTION}: {head}")


def purpose(root):
    """A file says first what it is for."""
    for path in counts.code_of(root, ("include", "src", "apps", "bench")):
        if not counts.has_purpose(path):
            yield f"{path.relative_to(root)}: begins without a sentence that says what it is for"


def riddles(root):
    """Comments begin with their subject or their verb."""
    for path in counts.code_of(root, ("include", "src", "apps", "bench", "tests", "python")):
        for number in counts.riddles(path):
            yield f"{path.relative_to(root)}:{number}: a comment that begins with Of, By, As, To be or Those"


def reasons(root):
    """Constants between a cloud and a force stand beside a unit and a reason."""
    for path in counts.code_of(root, ("include", "src")):
        if not set(counts.HEART) & set(path.parts):
            continue
        for name, number, told in counts.constants(path):
            if not told:
                yield f"{path.relative_to(root)}:{number}: {name} without a reason"


def classes(root):
    """Classes, and structs but plain ones (counts.classes), that fit into one head."""
    for path in counts.code_of(root):
        for name, number, methods, members in counts.classes(path):
            if methods > counts.MOST_METHODS or members > counts.MOST_MEMBERS:
                yield (f"{path.relative_to(root)}:{number}: {name} has {methods} methods and {members} members, "
                       f"more than {counts.MOST_METHODS} and {counts.MOST_MEMBERS}")


def readers(root):
    """What one file alone reads belongs to that file, as long as both make one module."""
    users = {}
    for path in sources(root):
        for name in counts.included(path):
            users.setdefault(name, set()).add(path)
    for path in sources(root, ("src", "apps")):
        if path.suffix != ".hpp":
            continue
        name = path.relative_to(root).as_posix()
        own = path.with_suffix(".cpp")
        reading = users.get(name.removeprefix("src/"), set()) | users.get(name, set())
        reading -= {own}
        if len(reading) != 1:
            continue
        reader, = reading
        if reader.relative_to(root).parts[0] not in {"src", "apps"} or reader.name == "main.cpp":
            continue
        together = sum(len(lines(file)) for file in (path, own, reader) if file.exists())
        if reader.suffix == ".cpp" and together <= LARGEST_MODULE:
            yield f"{name}: {reader.relative_to(root)} alone reads it, {together} lines together"


def proving(root):
    """Test cases assert something, themselves or by a helper."""
    for path, number, head in counts.unproven(root):
        yield f"{path.relative_to(root)}:{number}: asserts nothing: {head}"


def public_face(root):
    """What users see changes on purpose: with the list in tests/project/public_face.txt."""
    listed = root / "tests" / "project" / "public_face.txt"
    wanted = lines(listed) if listed.exists() else []
    there = [f"{path.relative_to(root / 'include')}: {' '.join(sorted(counts.types(path)))}".rstrip()
             for path in sources(root, ("include",))]
    for line in sorted(set(there) ^ set(wanted)):
        change = "is new; list it" if line in there else "is gone; take it off the list"
        yield f"{line}: {change} in tests/project/public_face.txt if that is wanted"


def readme(root):
    """The README is short."""
    count = len(lines(root / "README.md"))
    if count > 120:
        yield f"README.md: {count} lines, more than 120"


def links(root):
    """Relative links of the documents lead to files, and those of docs/ to headings that are there."""
    for path in (path for part in ("*.md", "docs/**/*.md", "bench/**/*.md", "web/*.md") for path in sorted(root.glob(part))):
        for target, anchor in re.findall(r"\]\(([^)#]*)(?:#([^)]*))?\)", path.read_text(encoding="utf-8")):
            there = path.parent / target if target else path
            if "://" in target or target.startswith("mailto:"):
                continue
            if not there.exists():
                yield f"{path.relative_to(root)}: {target} does not exist"
            elif anchor and there.suffix == ".md" and (root / "docs") in path.parents and anchor not in headings(there):
                yield f"{path.relative_to(root)}: {target} has no heading #{anchor}"


def images(root):
    """Images that documents show are there, also where the documents are installed."""
    documents = [path for part in ("*.md", "docs/**/*.md") for path in sorted(root.glob(part))]
    if not documents:
        yield f"{root}: there are no documents"
    for path in documents:
        for name in re.findall(r'(?:!\[[^\]]*\]\(|<img src=")([^)"]+)', path.read_text(encoding="utf-8")):
            if "://" not in name and not (path.parent / name).exists():
                yield f"{path.relative_to(root)}: there is no image {name}"


def headings(path):
    """The anchors of a document's headings, as GitHub and the site make them."""
    for title in re.findall(r"^#+ (.+)$", path.read_text(encoding="utf-8"), re.MULTILINE):
        yield re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def documents(root):
    """Comments and texts name documents that are there, and sections of docs/method.md that are."""
    method = root / "docs" / "method.md"
    text = method.read_text(encoding="utf-8") if method.exists() else ""
    sections = set(re.findall(r"^(?:##+ |\*\*)(\d+(?:\.\d+)?)", text, re.MULTILINE))
    for path, number, line in text_lines(root):
        # What follows a $ is a path that a script makes up.
        for name in re.findall(r"(?<![\w$./-])/?([\w.-][\w./-]*\.md)\b", line):
            if not any((base / name).exists() for base in (root, root / "docs", path.parent)):
                yield f"{path.relative_to(root)}:{number}: {name} does not exist"
        for section in re.findall(r"docs/method\.md (\d+(?:\.\d+)?)", line):
            if section not in sections:
                yield f"{path.relative_to(root)}:{number}: docs/method.md has no section {section}"


def refinements(root):
    """Rows of docs/refinements.md name sources and tests that are there, in the folders that it says."""
    path = root / "docs" / "refinements.md"
    cases = set()
    for test in sources(root, ("tests",)):
        for suite, case in re.findall(r"^TEST(?:_[FP])?\((\w+),\s*(\w+)\)", test.read_text(encoding="utf-8"), re.MULTILINE):
            cases |= {(test.parent.name, f"{suite}.{case}"), (test.parent.name, f"{suite}.*")}
    folders = {"src": [], "tests": []}
    for number, line in enumerate(lines(path) if path.exists() else [], 1):
        if "unless said" in line:
            folders = {top: re.findall(rf"`{top}/(\w+)`", line) for top in folders}
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|") or cells[0] == "rule" or set(line) <= set("|-"):
            continue
        if len(cells) != 5 or not all(cells):
            yield f"docs/refinements.md:{number}: give name, what it mends, section and source, test, and price"
            continue
        for said, name in in_folders(cells[2], r"[\w/]+\.(?:cpp|hpp|inl)"):
            wanted = said or folders["src"]
            if not any((root / "src" / folder / name).exists() for folder in wanted):
                yield f"docs/refinements.md:{number}: there is no source {name} in {' or '.join(wanted)}"
        for said, name in in_folders(cells[3], r"\w+\.(?:\w+|\*)"):
            wanted = said or folders["tests"]
            if not any((folder, name) in cases for folder in wanted):
                yield f"docs/refinements.md:{number}: there is no test {name} in {' or '.join(wanted)}"


def in_folders(cell, name):
    """The names between backticks in a cell, and the folder, if any, that stands before them or before an earlier one."""
    said = []
    for folder, found in re.findall(rf"(\w+ )?`({name})`", cell):
        said = [folder.strip()] if folder else said
        yield said, found


def changelog(root):
    """Each entry of CHANGELOG.md is one line of 160 characters at most; the newest release is the project's version."""
    head, _, entries = (root / "CHANGELOG.md").read_text(encoding="utf-8").partition("## [Unreleased]")
    for number, line in enumerate(entries.splitlines(), head.count("\n") + 1):
        if line.startswith(" ") or len(line) > 160:
            yield f"CHANGELOG.md:{number}: an entry is one line of at most 160 characters"
    newest = re.search(r"^## \[(\d[\d.]*)\]", entries, re.MULTILINE)[1]
    if f"project(palpate VERSION {newest} " not in (root / "CMakeLists.txt").read_text(encoding="utf-8"):
        yield f"CMakeLists.txt: the version is not {newest}, the newest release of CHANGELOG.md"


def remedies(root):
    """What messages about files tell people to do is done by a test: tests/project/remedies.txt says by which."""
    listed = root / "tests" / "project" / "remedies.txt"
    rows = [[cell.strip() for cell in line.split("|")] for line in (lines(listed) if listed.exists() else [])
            if line.strip() and not line.startswith("#")]
    told = [(path.relative_to(root).as_posix(), number, line)
            for path in sources(root, ("src", "python", "apps")) if set(REMEDY_FLOORS) & set(path.relative_to(root).parts[:2])
            for number, line in enumerate(lines(path), 1)
            if REMEDY.search(line) and '"' in line and not line.lstrip().startswith("//")]
    for name, number, line in told:
        if not any(row[0] == name and row[1] in line for row in rows):
            yield f"{name}:{number}: a remedy that no line of tests/project/remedies.txt names: {line.strip()}"
    cases = None
    for name, words, test in rows:
        if not any(name == each and words in line for each, _, line in told):
            yield f"tests/project/remedies.txt: {name} tells nobody to {words}"
        if test.startswith("not run: "):
            continue
        cases = cases or {".".join(case) for path in sources(root, ("tests",))
                          for case in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", path.read_text("utf-8"), re.M)}
        if test not in cases:
            yield f"tests/project/remedies.txt: there is no test {test}"


def text_lines(root):
    """All lines of what is written by hand, but of the tests of these rules."""
    for folder in (*SOURCE_FOLDERS, "cmake", "scripts", "web"):
        for path in sorted((root / folder).rglob("*")):
            if not path.is_file() or {"node_modules", "dist"} & set(path.parts):
                continue
            if path.suffix in TEXT_SUFFIXES and path.name != "rules_test.py":
                for number, line in enumerate(lines(path), 1):
                    yield path, number, line


RULES = {rule.__name__: rule
         for rule in (floors, drawn, steps, rooms, public_headers, macros, marks, size, functions, purpose, riddles,
                      reasons, classes, readers, proving,
                      public_face, readme, links, images, documents, refinements, remedies, changelog)}


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in RULES:
        print(__doc__, "Rules:", ", ".join(RULES))
        return 2
    default = pathlib.Path(__file__).resolve().parents[2]
    root = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else default
    broken = list(RULES[sys.argv[1]](root))
    print("\n".join(broken) or f"{sys.argv[1]}: kept")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
