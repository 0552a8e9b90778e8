#!/usr/bin/env bash
# Builds the documentation as one static site: build/docs/html/index.html.
#
# Pages are docs/ and what it links to; pictures and references are made by the program as it is.
# A warning, a link that leads nowhere, or a command without its picture is an error.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
if [ $# -gt 0 ]; then
  sed -n '2,5s/^# \{0,1\}//p' "$0"
  exit
fi
started=$SECONDS

say "packages"
need_packages build viewer ros python picture docs
need_npm

say "program, examples and Python module"
if ! { [ -f build/release/CMakeCache.txt ] && cmake --preset release >/dev/null 2>&1; }; then
  configure release -DPALPATE_BUILD_TESTS=OFF
fi
build release palpate_app palpate_python examples

say "pages"
rm -rf build/docs
mkdir build/docs
doxygen - >build/docs/doxygen.log 2>&1 <<'END' || { cat build/docs/doxygen.log >&2; fail "doxygen found something wrong"; }
INPUT = include
RECURSIVE = YES
OUTPUT_DIRECTORY = build/docs
STRIP_FROM_PATH = include
EXTRACT_ALL = YES
JAVADOC_AUTOBRIEF = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
QUIET = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
END
sed -i 's|<initializer>= {[.].*</initializer>||' build/docs/xml/*.xml  # Sphinx 5 reads no designated initializers
PATH=/usr/bin:$PATH scripts/docs.py build/docs/pages
note "pages and pictures: $((SECONDS - started)) s"

say "the page of a tab"
tab=
if [ -f "${XDG_CACHE_HOME:-$HOME/.cache}/palpate/emscripten/config" ]; then
  scripts/tab.sh --site
  tab=build/web/site
  # Nothing of it is loaded before somebody opens it.
  sed -i 's|^<!-- the page of a tab -->$|<details><summary>Touch it here</summary><iframe src="tab/index.html" loading="lazy" title="palpate in this tab" style="width: 100%; height: 36rem; border: 0"></iframe></details>|' build/docs/pages/try.*
else
  note "skipped: its compiler is not there (scripts/tab.sh fetches it)"
fi
/usr/bin/python3 -m sphinx -W --keep-going -q -j auto -c docs -d build/docs/doctrees build/docs/pages build/docs/html
if [ -n "$tab" ]; then cp -r "$tab" build/docs/html/tab; fi
note "build/docs/html/index.html ($(find build/docs/html -name '*.html' | wc -l) pages, $((SECONDS - started)) s)"
