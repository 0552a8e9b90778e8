# shellcheck shell=bash disable=SC2034
# A compiler for WebAssembly and the sources of the libraries that the core needs there; sourced after lib.sh. Debian 12's
# own Emscripten is too old, its C++ library lacks ranges. So Debian 13's is unpacked, not installed, into
# ~/.cache/palpate/emscripten, and uses the clang of the distribution.

# Ends the script where there can be no such compiler.
no_emscripten() {
  note "emscripten: skipped, $*"
  exit 77
}

# The archive of Debian in apt's own list of indexes; it holds all of Debian's versions. apt expands the $(...).
# shellcheck disable=SC2016
debian_mirror() {
  apt-get indextargets --format '$(REPO_URI) $(ORIGIN) $(COMPONENT)' 'Created-By: Packages' 2>/dev/null |
    awk '$1 !~ /security/ && $2 == "Debian" && $3 == "main" && !found++ { print $1 }' || true
}

# apt-get with sources of its own, so that nothing of it reaches the machine's packages.
apt_apart() {
  apt-get -q -o Dir::Etc::SourceList="$wasm/sources.list" -o Dir::Etc::SourceParts=- -o Dir::State::Lists="$wasm/lists" \
    -o Dir::Cache="$wasm/cache" -o APT::Sandbox::User=root "$@"
}

# Programs of Debian 13 that are started with its C library.
wrap_binaryen() {
  local program
  mkdir -p "$wasm/binaryen/bin"
  for program in "$wasm"/host/usr/bin/*; do
    printf '#!/bin/sh\nexec "%s" --library-path "%s" "%s" "$@"\n' "$wasm/host/usr/lib64/ld-linux-x86-64.so.2" \
      "$wasm/host/usr/lib/x86_64-linux-gnu" "$program" >"$wasm/binaryen/bin/${program##*/}"
    chmod +x "$wasm/binaryen/bin/${program##*/}"
  done
}

write_em_config() {
  cat >"$wasm/config" <<END
EMSCRIPTEN_ROOT = '$wasm/root/usr/share/emscripten'
LLVM_ROOT = '/usr/bin'
BINARYEN_ROOT = '$wasm/binaryen'
NODE_JS = '$(command -v node)'
FROZEN_CACHE = True
LLVM_ADD_VERSION = '19'
CLANG_ADD_VERSION = '19'
END
}

fetch_emscripten() {
  local mirror package
  mirror=$(debian_mirror)
  [ -n "$mirror" ] || no_emscripten "apt has no Debian here: put an em++ of 3.1.69 or newer on the PATH"
  rm -rf "$wasm"
  mkdir -p "$wasm"/lists/partial "$wasm"/cache/archives/partial "$wasm"/packages "$wasm"/libraries
  printf '%s [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] %s trixie main\n' deb "$mirror" deb-src "$mirror" \
    >"$wasm/sources.list"
  note "emscripten: from $mirror (250 MB), once"
  (
    apt_apart update
    cd "$wasm/packages" && apt_apart download emscripten binaryen libc6 libstdc++6 libgcc-s1
    cd "$wasm/libraries" && apt_apart source --download-only --tar-only zlib libspng pugixml libzstd brotli
  ) >build/emscripten.log 2>&1 || { tail -n 20 build/emscripten.log >&2; no_emscripten "$mirror does not serve it"; }
  dpkg-deb -x "$wasm"/packages/emscripten_*.deb "$wasm/root"
  for package in "$wasm"/packages/{binaryen,libc6,libstdc++6,libgcc-s1}_*.deb; do dpkg-deb -x "$package" "$wasm/host"; done
  for package in "$wasm"/libraries/*.orig.tar.*; do
    if [[ $package != *.asc ]]; then tar -C "$wasm/libraries" -xf "$package"; fi
  done
  (cd "$wasm" && npm install --no-audit --no-fund --no-save --ignore-scripts --prefix . acorn@8) >>build/emscripten.log 2>&1 ||
    { tail -n 20 build/emscripten.log >&2; no_emscripten "npm could not install acorn, which its linker wants"; }
  rm -rf "$wasm"/packages "$wasm"/lists "$wasm"/cache
  wrap_binaryen
  write_em_config
}

# need_emscripten: sets `wasm`, the folder that holds it all, and what cmake's preset `web` asks for.
need_emscripten() {
  wasm=${XDG_CACHE_HOME:-~/.cache}/palpate/emscripten
  need_packages wasm
  need_npm
  if [ ! -f "$wasm/config" ]; then fetch_emscripten; fi
  export EM_CONFIG=$wasm/config EMSCRIPTEN=$wasm/root/usr/share/emscripten PALPATE_WEB_LIBRARIES=$wasm/libraries
  note "emscripten: $(cat "$EMSCRIPTEN/emscripten-version.txt")"
}
