#!/usr/bin/env bash
# Makes Debian packages and tries them: scripts/package.sh [MIRROR]
#
# What is committed is packed: sources, with the page that npm builds here, then packages, in a bare Debian 12 root and
# without a network. lintian looks at them; all lies in build/packages. In another bare root they replace older ones, do
# what packaging/debian/tests asks, and leave nothing behind when they are purged. Both roots stay for a look. Where none
# can be made, the reason is told and the status is 77. MIRROR: as scripts/fresh_root.sh takes it.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
# shellcheck source=scripts/bare_root.sh
source scripts/bare_root.sh
case "${1:-}" in -*)
  sed -n '2,7s/^# \{0,1\}//p' "$0"
  exit 2
  ;;
esac
out=$PWD/build/packages
log=$PWD/build/package
get="apt-get install -y -qq --no-install-recommends"
started=$SECONDS

# The sources of a release: what git holds, and the page.
make_sources() {
  local version tree=$root/root/palpate
  version=$(sed -n '1s/.*(\(.*\)-.*/\1/p' packaging/debian/changelog)
  grep -q "VERSION $version " CMakeLists.txt || fail "packaging/debian/changelog is of another version, $version"
  mkdir "$tree"
  git archive HEAD | tar -x -C "$tree"
  # Debian wants a page that can be read beside the one that is small.
  ln -s "$PWD/web/node_modules" "$tree/web"
  (cd "$tree/web" && PALPATE_PAGE=page npm run build && node_modules/.bin/esbuild src/main.ts --bundle --format=iife \
    --target=es2022 --line-limit=400 --preserve-symlinks --outfile=page/app.debug.js) >"$log.page.log" 2>&1 ||
    { tail -n 20 "$log.page.log" >&2; fail "npm cannot build the page"; }
  rm "$tree/web/node_modules"
  tar -C "$root/root" --sort=name --owner=root:0 --group=root:0 --mtime="@$(git log -1 --format=%ct)" \
    --transform "s,^palpate,palpate-$version," -cJf "$root/root/palpate_$version.orig.tar.xz" palpate
  cp -r "$tree/packaging/debian" "$tree/debian"
}

# older PACKAGE FOLDER: the same of an earlier version, with a file more and another line in each configuration file.
older() {
  local parts=$2/parts name version
  dpkg-deb -R "$1" "$parts"
  name=$(sed -n 's/^Package: //p' "$parts/DEBIAN/control")
  version=$(sed -n 's/^Version: //p' "$parts/DEBIAN/control")
  sed -i "s/ $version\b/ ${version%-*}-0~old/" "$parts/DEBIAN/control"
  touch "$parts/usr/share/stale-$name"
  find "$parts/etc" -type f -exec sed -i '$a # older' {} + 2>/dev/null || true
  dpkg-deb -b "$parts" "$2/$name.deb" >/dev/null
  rm -r "$parts"
}

say "sources"
can_make_roots "$@"
need_npm
need_modules web
git diff --quiet HEAD || note "uncommitted changes are not packed"
make_root package_root
make_sources
note "created in $((SECONDS - started)) s"

timed "apt-get update -qq && $get $(packages_of package | xargs) && apt-get build-dep -y -qq --no-install-recommends ./" \
  "$log.apt.log"
shared=${CCACHE_DIR:-$HOME/.cache/ccache}
mkdir -p "$shared"
timed "CCACHE_DIR=/var/cache/shared CMAKE_CXX_COMPILER_LAUNCHER=ccache DEB_BUILD_OPTIONS=parallel=$(jobs_that_fit) \
  unshare --net dpkg-buildpackage -us -uc" "$log.build.log"
shared=
rm -rf "$out"
mkdir "$out"
cp "$root"/root/*palpate*_* "$out"
timed "lintian --allow-root --pedantic --display-info --fail-on error ../palpate_*_amd64.changes" "$out/lintian.txt"
cat "$out/lintian.txt"

say "another root, with older packages"
make_root trial_root
mkdir "$root"/root/{palpate,old,new}
git archive HEAD packaging/debian/tests examples tests/apps/golden tests/project | tar -x -C "$root/root/palpate"
for package in "$out"/*_amd64.deb; do
  if [[ $package == *dbgsym* ]]; then continue; fi
  cp "$package" "$root/root/new"
  older "$package" "$root/root/old"
done
timed "apt-get update -qq && $get ../old/*.deb && ls /usr/share/stale-*palpate*" "$log.trial.log"
timed "$get ../new/*.deb && ! ls /usr/share/stale-* && test -z \"\$(dpkg --verify palpate)\" && grep realtime /etc/group" \
  "$log.upgrade.log"
timed packaging/debian/tests/program
timed "$get $(sed -n 's/^Depends: libpalpate-dev, //p' packaging/debian/tests/control | tr -d ,)" "$log.tools.log"
timed packaging/debian/tests/library "$log.library.log"
timed "$get qemu-user" "$log.qemu.log"
timed "python3 tests/project/older_processor.py /usr/bin/palpate /tmp/older qemu64,-pni"  # no more than SSE2
timed "apt-get remove -y -qq '?name(palpate)' && test -f /etc/security/limits.d/palpate-limits.conf" "$log.remove.log"
timed "apt-get purge -y -qq '?name(palpate)'" "$log.purge.log"
left=$(find "$root" -xdev -name '*palpate*' -not -path "$root/root/*")
[ -z "$left" ] || fail "purged packages leave behind: $left"

say "packages (after $((SECONDS - started)) s)"
(cd "$out" && du -h --apparent-size -- *)
