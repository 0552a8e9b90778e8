#!/usr/bin/python3
"""Lays out the pages of the site: docs.py FOLDER. scripts/docs.sh calls it.

Pages are docs/ and the documents that they link to. Links lead to pages, else to files that are downloaded. Behind a block of
commands that writes pictures these follow, and the source of the example that it runs. What the program, the Python module and
the headers say of themselves becomes pages of reference/.
"""

import ast
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path += [str(ROOT / "tests" / "project"), str(ROOT / "build" / "release" / "python")]
sys.dont_write_bytecode = True
import blocks  # noqa: E402
import palpate  # noqa: E402

PROGRAM = ROOT / "build" / "release" / "apps" / "palpate" / "palpate"
XML = ROOT / "build" / "docs" / "xml"
LINK = re.compile(r"(?<=\]\()([^)\s]+)(?=\))|(?<=<img src=\")([^\"]+)(?=\")")
# What is generated, and what of the tree it describes.
REFERENCE = {"tests/apps/golden": "program", "python/palpate/__init__.pyi": "python", "include/palpate": "cpp"}


def pages():
    """Where each document stands in the site: what is in docs/ as there, the rest beside it."""
    found = {path: path.relative_to(ROOT / "docs") for path in (ROOT / "docs").rglob("*.md")}
    for name in ("CHANGELOG.md", "CONTRIBUTING.md", "bench/README.md", "bench/RESULTS.md", "bench/RIVALS.md", "web/README.md"):
        found[ROOT / name] = pathlib.Path(name)
    for note in (ROOT / "bench" / "notes").glob("*.md"):
        found[note] = note.relative_to(ROOT)
    return found


def led(target, path, where, out):
    """A link of the document at `path`, as it is on its page."""
    name, _, anchor = target.partition("#")
    if not name or "://" in target or target.startswith("mailto:"):
        return target
    to = (path.parent / name).resolve()
    if not to.exists():
        sys.exit(f"docs.py: {path.relative_to(ROOT)}: {target} does not exist")
    inside = to.relative_to(ROOT).as_posix()
    if to in where:
        page = out / where[to]
    elif inside in REFERENCE:
        page = out / "reference" / f"{REFERENCE[inside]}.md"
    elif inside.startswith("include/palpate/"):
        page = out / "reference" / "cpp" / (inside.split("/")[2] + ".md")
    elif inside == "examples":
        page = out / "gallery.md"
    elif to.is_file():
        page = to
    else:
        return None
    return os.path.relpath(page, (out / where[path]).parent) + (f"#{anchor}" if anchor else "")


def relinked(text, path, where, out):
    """A document's text with its links led; what stands in code stays as it is, and folders lose their link."""
    parts = re.split(r"(^ *```.*?^ *```$|`[^`\n]+`)", text, flags=re.MULTILINE | re.DOTALL)
    for at in range(0, len(parts), 2):
        parts[at] = LINK.sub(lambda found: led(found[0], path, where, out) or "FOLDER", parts[at])
    return re.sub(r"\[([^\]]*)\]\(FOLDER\)", r"\1", "".join(parts))


def shown(found, desk, folder, page):
    """A block of commands, followed by the pictures that it makes and the example that it runs."""
    pictures = re.findall(r"([\w-]+\.png)", found[3]) if found[2] == "sh" else []
    made = []
    for line in found[3].replace("\\\n", " ").splitlines():
        if re.search(r"\.png", line) and found[2] == "sh" and not line.startswith(("sudo", "scripts")):
            for output in re.findall(r"--output (\S+)", line):  # it overwrites nothing
                (desk / output).unlink(missing_ok=True)
            done = subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=desk, capture_output=True, text=True, check=False)
            if done.returncode:
                sys.exit(f"docs.py: '{line}' ends with {done.returncode}: {done.stderr}")
    for name in pictures:
        shutil.copy(desk / name, folder / f"{page}-{name}")
        made.append(f"\n\n{found[1]}![What the command draws](/pictures/{page}-{name})")
    for source in re.findall(r"build/release/(examples/\w+)|(examples/python/\w+)\.py", found[3]):
        name = f"{source[0]}.cpp" if source[0] else f"{source[1]}.py"
        language = "cpp" if source[0] else "python"
        made.append(f"\n\n<details><summary>{name}</summary>\n\n```{language}\n{(ROOT / name).read_text()}```\n\n</details>")
    return found[0] + "".join(made)


def trees(text):
    """The site's order: the list under each heading of the index is a part of the menu."""
    def tree(section):
        links = re.findall(r"\]\(([^)]+)\.md\)", section[2])
        return f"## {section[1]}\n{section[2]}\n```{{toctree}}\n:hidden:\n:caption: {section[1]}\n\n" + "\n".join(links) + "\n```\n\n"
    return re.sub(r"^## ([^\n]*)\n(.*?)(?=^## |\Z)", tree, text, flags=re.MULTILINE | re.DOTALL)


def program_reference():
    """The help of every command."""
    def told(*words):
        return subprocess.run([PROGRAM, *words, "--help"], capture_output=True, text=True, check=True).stdout
    yield "# The program's commands\n\n{doc}`/touch` explains sources, reports, logs and pictures.\n"
    yield f"```text\n{told()}```\n"
    for name in re.findall(r"^  ([a-z]+)  ", told().split("Subcommands:")[1], re.MULTILINE):
        yield f"## palpate {name}\n\n```text\n{told(name)}```\n"


def python_reference():
    """The stubs' signatures with what the module says of each."""
    tree = ast.parse((ROOT / "python" / "palpate" / "__init__.pyi").read_text(encoding="utf-8"))
    kinds = [f"{ast.unparse(node)}\n" for node in tree.body if isinstance(node, ast.Assign)]
    yield f"# Python\n\n`import palpate`. {{doc}}`/python` shows how it is used.\n\n{in_python(''.join(kinds))}"
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield f"## {node.name}\n\n{signature(node.name, node)}{described(getattr(palpate, node.name))}"
        elif isinstance(node, ast.ClassDef):
            owner = getattr(palpate, node.name)
            yield f"## {node.name}\n\n{described(owner)}"
            yield from (python_member(member, owner) for member in node.body if isinstance(member, ast.FunctionDef))


def python_member(member, owner):
    """A property as an entry of a list, a function with its signature."""
    if any(ast.unparse(mark) == "property" for mark in member.decorator_list):
        words = described(getattr(owner, member.name)).replace("\n", " ")
        return f"- **`{member.name}`** `{plain(ast.unparse(member.returns))}` {words}"
    if member.name == "__init__":
        return signature(owner.__name__, member)
    if member.name.startswith("__"):
        return ""
    return f"\n{signature(f'{owner.__name__}.{member.name}', member)}{described(getattr(owner, member.name))}"


def signature(name, function):
    """A line, or one for each argument."""
    arguments = plain(ast.unparse(function.args)).removeprefix("self").removeprefix(", ")
    if len(arguments) > 70:
        arguments = "\n    " + re.sub(r", (?=\*|\w+(: |=))", ",\n    ", arguments)
    returns = ast.unparse(function.returns)
    return in_python(f"{name}({arguments})" + ("" if returns == "None" else f" -> {returns}") + "\n")


def in_python(text):
    return f"```python\n{plain(text)}```\n\n"


def plain(text):
    """Names of the stubs' own kinds of argument without their underscore."""
    return re.sub(r"\b_([A-Z]\w*)", r"\1", text)


def described(what):
    """A docstring as text: what its lines say, without what Markdown would make of it."""
    text = (what.__doc__ or "").strip()
    return re.sub(r"([\\*_\[\]<>])", r"\\\1", text) + "\n" if text else ""


def cpp_reference(out):
    """A page for each folder of headers: what each header defines, in its order."""
    space = {}
    for node in ElementTree.parse(XML / "namespacepalpate.xml").iter("memberdef"):
        space.setdefault(node.find("location").get("file"), []).append(node)
    floors = sorted(path for path in (ROOT / "include" / "palpate").iterdir() if path.is_dir())
    for floor in floors:
        text = f"# {floor.name}/\n\n"
        for header in sorted(floor.glob("*.hpp")):
            name = header.relative_to(ROOT / "include").as_posix()
            entries = [*cpp_types(name), *(entry for node in space.get(name, []) for entry in cpp_member(node))]
            text += f"## {header.name}\n\n```cpp\n#include <{name}>\n```\n\n" + "".join(
                f"```{{doxygen{kind}}} {which}\n{options}```\n\n" for _, kind, which, options in sorted(entries))
        write(out / "reference" / "cpp" / f"{floor.name}.md", text)
    yield "# C++\n\n`#include <palpate/palpate.hpp>` is what a loop of your own needs. Each folder is a floor of the {doc}`/architecture`.\n"
    yield "```{toctree}\n" + "\n".join(f"cpp/{floor.name}" for floor in floors) + "\n```\n"


def cpp_types(header):
    """Classes and structs of a header; those within another come with it."""
    for path in [*XML.glob("structpalpate_*.xml"), *XML.glob("classpalpate_*.xml")]:
        node = ElementTree.parse(path).find("compounddef")
        name = node.find("compoundname").text
        if node.find("location").get("file") == header and name.count("::") == 1:
            yield int(node.find("location").get("line")), node.get("kind"), name, ":members:\n:undoc-members:\n"


def cpp_member(node):
    """An enumeration, an alias or a function of the namespace."""
    kind, name = node.get("kind"), f"palpate::{node.find('name').text}"
    if kind == "function":
        types = ("".join(param.find("type").itertext()) for param in node.findall("param"))
        name = f"{name}({', '.join(types)})"
    if kind in {"function", "enum", "typedef", "variable"} and "operator" not in name:
        yield int(node.find("location").get("line")), kind, name, ""


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def make_desk(folder):
    """The files that documents name, with a rabbit as the scan; build/ and examples/ are found from there."""
    desk = blocks.Desk(PROGRAM, folder).folder
    for name in ("bunny.ply", "scan.ply"):
        palpate.write_cloud(desk / name, palpate.synthetic_cloud("rabbit", noise=2e-4))
    for name in ("build", "examples"):
        (desk / name).symlink_to(ROOT / name)
    return desk


def main():
    out = pathlib.Path(sys.argv[1]).resolve()
    os.environ["PATH"] = f"{PROGRAM.parent}:{os.environ['PATH']}"
    (out / "pictures").mkdir(parents=True)
    where = pages()
    index = ROOT / "docs" / "index.md"
    menu = re.findall(r"\]\(([^)#]+\.md)\)", relinked(index.read_text(encoding="utf-8"), index, where, out))
    with tempfile.TemporaryDirectory() as folder:
        desk = make_desk(folder)
        for path, page in where.items():
            text = relinked(path.read_text(encoding="utf-8"), path, where, out)
            text = blocks.FENCE.sub(lambda found: shown(found, desk, out / "pictures", page.stem), text)
            if page.name == "index.md":
                text = trees(text)
            elif page.as_posix() not in menu:
                text = f"---\norphan: true\n---\n\n{text}"  # links lead to it, the menu does not
            write(out / page, text)
    for name, parts in (("program", program_reference()), ("python", python_reference()), ("cpp", cpp_reference(out))):
        write(out / "reference" / f"{name}.md", "\n".join(parts))


if __name__ == "__main__":
    main()
