#!/usr/bin/env bash
# Builds a tab's program as WebAssembly, the page of a tab in build/web/site, and build/web/palpate-tab, which puts it into
# other pages; tests them and what they are made of, hostile files under sanitizers, and that forces are those of a native
# build of portable bits, bit for bit. --test: the page and its module alone. --module: the module alone. --site: builds
# alone. --serve: builds, and serves the page on http://127.0.0.1:8430/.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
# shellcheck source=scripts/emscripten.sh
source scripts/emscripten.sh

# licences FOLDER: what is compiled into the page asks that its notices go with it.
licences() {
  local file
  for file in /usr/share/doc/{libeigen3-dev,libfmt-dev,nlohmann-json3-dev}/copyright "$wasm"/libraries/*/LICENSE* \
    "$wasm/root/usr/share/doc/emscripten/copyright" web/node_modules/{three,uplot}/LICENSE; do
    printf '==== %s\n\n' "$(basename "$(dirname "$file")")"
    cat "$file"
    printf '\n'
  done >"$1/THIRD_PARTY.txt"
}

# What any server of files can serve: no header of its own is wanted.
build_site() {
  local site=build/web/site
  build web tab
  need_modules web
  rm -rf "$site"
  mkdir -p "$site"
  (cd web && node build.mjs --tab "../$site")
  cp build/web/tab/tab.js build/web/tab/tab.wasm "$site"
  licences "$site"
  note "$site: $(du -sk "$site" | cut -f1) kB"
  local package=build/web/palpate-tab version
  version=$(sed -n 's/^project(palpate VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
  [ -n "$version" ] || fail "CMakeLists.txt names no version"
  rm -rf "$package"
  (cd web && node build.mjs --tab-package "../$package" "$version")
  cp -r "$site" "$package/page"
}

case "${1:-}" in
  "" | --test | --module | --site | --serve) ;;
  *)
    sed -n '2,5s/^# //p' "$0"
    exit
    ;;
esac
need_packages build test
need_emscripten
find_data
native=$PWD/build/portable/tests/forces/forces
if [ $# -eq 0 ]; then
  configure portable
  build portable forces
fi
cmake --preset web -DPALPATE_NATIVE_FORCES="$native" >build/web.configure.log 2>&1 ||
  { cat build/web.configure.log >&2; fail "cmake could not configure preset web"; }
build_site
if [ "${1:-}" = --serve ]; then exec python3 -m http.server 8430 --bind 127.0.0.1 --directory build/web/site; fi
if [ "${1:-}" = --site ]; then exit; fi
if [ $# -eq 0 ]; then
  build web
  test_preset web
  configure websan
  build websan io_test tab
  test_preset websan -R '^(io|tab)'
else
  test_preset web -R '^tab/'
fi
if [ "${1:-}" = --module ]; then exit; fi
PALPATE_SITE=$PWD/build/web/site tests/page/check.sh tab web "$PWD/build/web/pictures" build/web/site || [ $? -eq 77 ]
