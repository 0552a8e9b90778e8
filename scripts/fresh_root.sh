#!/usr/bin/env bash
# Tries what the README promises where nothing is installed: makes a Debian 12 root in
# build/fresh_root, clones this repository into it, and runs scripts/demo.sh there.
#
# scripts/fresh_root.sh [--test] [MIRROR]
#   --test   runs the demo a second time and scripts/test.sh, too
#   MIRROR   default: the one that this machine's apt uses
# What is committed is what is tried. Each run begins with a root that holds nothing but apt, of which
# ~/.cache/palpate keeps a copy for a month. The root stays for a look until the next run removes it;
# nothing stays mounted. Where none can be made, the reason is told and the status is 77.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
with_test=no
case "${1:-}" in
  --test)
    with_test=yes
    shift
    ;;
  -*)
    sed -n '2,10s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac
root=$PWD/build/fresh_root
kept=${XDG_CACHE_HOME:-~/.cache}/palpate/bookworm.tar

cannot() {
  note "fresh root: skipped, $*"
  exit 77
}

# The first archive of Debian 12 in apt's own list of indexes. apt expands the $(...), not the shell.
# shellcheck disable=SC2016
mirror_of_apt() {
  apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' 2>/dev/null |
    awk '$2 == "bookworm" && !found++ { print $1 }' || true
}

# Debian as debootstrap leaves it: from the copy, if that is whole and not old.
make_root() {
  rm -rf --one-file-system "$root"
  mkdir "$root"
  if [ -n "$(find "$kept" -mtime -30 2>/dev/null)" ] && tar -C "$root" -xf "$kept"; then
    note "from $kept"
    return
  fi
  rm -rf --one-file-system "$root"
  debootstrap --variant=minbase bookworm "$root" "$mirror" >build/debootstrap.log 2>&1 ||
    { tail -n 20 build/debootstrap.log >&2; fail "debootstrap failed; full log: build/debootstrap.log"; }
  if mkdir -p "${kept%/*}" && tar -C "$root" -cf "$kept.$$" . && mv "$kept.$$" "$kept"; then
    note "a copy is kept: $kept"
  else
    rm -f "$kept.$$"
  fi
}

# Lets the root reach the network as this machine does, and install quickly.
connect_root() {
  echo "deb $mirror bookworm main" >"$root/etc/apt/sources.list"
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/quick"  # it need not survive a loss of power
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  apt-config dump Acquire | grep -E '^Acquire::[a-z]+::Proxy ' >"$root/etc/apt/apt.conf.d/99proxy" || true
  # A network that looks into encrypted connections has an authority of its own, which npm has to know.
  if [ -f /etc/ssl/certs/ca-certificates.crt ]; then
    cp /etc/ssl/certs/ca-certificates.crt "$root/etc/host-certificates.crt"
  fi
}

# Runs a command in the repository in the root, with /proc and /dev that vanish with it.
inside() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc"
    mount --rbind /dev "$0/dev"
    exec chroot "$0" /usr/bin/env -i HOME=/root LANG=C.UTF-8 \
      NODE_EXTRA_CA_CERTS=/etc/host-certificates.crt \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      bash -c "cd /root/palpate && $1"' "$root" "$1"
}

timed() {
  local started=$SECONDS
  say "in the fresh root: $1"
  inside "$1" </dev/null || fail "in the fresh root: $1; inspect it with: chroot $root"
  note "took $((SECONDS - started)) s: $1"
}

started=$SECONDS
say "fresh root"
[ "$(id -u)" -eq 0 ] || cannot "it needs root"
unshare --mount --pid --fork true 2>/dev/null || cannot "root may mount nothing here"
need_packages fresh
mirror=${1:-$(mirror_of_apt)}
if [ -z "$mirror" ]; then
  apt-get update -qq || true
  mirror=$(mirror_of_apt)
fi
[ -n "$mirror" ] || cannot "apt has no Debian 12 here: name a mirror"
make_root
connect_root
git diff --quiet HEAD || note "uncommitted changes are not tested"
git clone --quiet --no-hardlinks "$PWD" "$root/root/palpate"
note "created in $((SECONDS - started)) s"

timed "scripts/demo.sh --headless --duration 5"
[ -f "$root/root/palpate/build/release/src/viewer/page/app.js" ] || fail "in the fresh root: the page was not built"
if [ "$with_test" = yes ]; then
  timed "scripts/demo.sh --headless --duration 5"
  timed scripts/test.sh
fi
