"""How Sphinx makes the site of the pages that scripts/docs.py lays out."""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[1]

project = "palpate"
version = release = re.search(r"project\(palpate VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
extensions = ["myst_parser", "breathe"]
myst_enable_extensions = ["html_image"]
myst_heading_anchors = 4
breathe_projects = {"palpate": str(ROOT / "build" / "docs" / "xml")}
breathe_default_project = "palpate"
html_theme = "furo"
html_title = f"palpate {version}"
html_copy_source = html_show_sphinx = html_show_copyright = False
html_static_path = ["site.css"]
html_css_files = ["site.css"]
