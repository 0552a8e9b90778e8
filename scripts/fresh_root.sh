#!/usr/bin/env bash
# Tries what the README promises where nothing is installed: makes a Debian 12 root in DIR, clones
# this repository into it, and runs scripts/demo.sh there twice. Needs root and debootstrap.
#
# scripts/fresh_root.sh [--test] DIR [MIRROR]
#   --test   runs scripts/test.sh in it as well
#   MIRROR   default: the one that this machine's apt uses
# What is committed is what is tried. DIR is left as it is afterwards; run again to try the demo on
# top of it, or remove it for a fresh start. Nothing stays mounted.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
with_test=no
if [ "${1:-}" = --test ]; then
  with_test=yes
  shift
fi
if [ $# -lt 1 ] || [ "$1" = --help ]; then
  sed -n '2,9s/^# \{0,1\}//p' "$0"
  exit 2
fi
[ "$(id -u)" -eq 0 ] || fail "a fresh root needs root"
command -v debootstrap >/dev/null || fail "debootstrap is absent: apt-get install debootstrap"

root=$(cd "$called_from" && realpath -m "$1")
# The first archive of Debian 12 in apt's own list of indexes. apt expands the $(...), not the shell.
# shellcheck disable=SC2016
mirror=${2:-$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' \
  2>/dev/null | awk '$2 == "bookworm" { print $1; exit }')}
[ -n "$mirror" ] || fail "no Debian 12 mirror in apt's sources: name one as second argument"

if [ ! -f "$root/etc/debian_version" ]; then
  say "debootstrap of bookworm into $root"
  debootstrap --variant=minbase bookworm "$root" "$mirror" >"build/debootstrap.log" 2>&1 ||
    { tail -n 20 build/debootstrap.log >&2; fail "debootstrap did not finish"; }
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"
apt-config dump Acquire | grep -E '^Acquire::[a-z]+::Proxy ' >"$root/etc/apt/apt.conf.d/99proxy" || true
# A network that looks into encrypted connections has an authority of its own, which npm has to know.
if [ -f /etc/ssl/certs/ca-certificates.crt ]; then
  cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/host-certificates.crt"
fi

say "clone"
rm -rf "$root/root/palpate/.git"
git clone --quiet --no-hardlinks "$PWD" "$root/root/palpate.new"
if [ -d "$root/root/palpate/build" ]; then mv "$root/root/palpate/build" "$root/root/palpate.new/"; fi
rm -rf "$root/root/palpate"
mv "$root/root/palpate.new" "$root/root/palpate"

# Runs a command in the repository in the root, with /proc and /dev that vanish with it.
inside() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  unshare --mount --pid --fork bash -c '
    mount -t proc proc "$0/proc"
    mount --rbind /dev "$0/dev"
    exec chroot "$0" /usr/bin/env -i HOME=/root LANG=C.UTF-8 \
      NODE_EXTRA_CA_CERTS=/etc/ssl/host-certificates.crt \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      bash -c "cd /root/palpate && $1"' "$root" "$1"
}

timed() {
  local started=$SECONDS
  say "in the fresh root: $1"
  inside "$1"
  note "took $((SECONDS - started)) s: $1"
}

timed "scripts/demo.sh --headless --duration 5"
timed "scripts/demo.sh --headless --duration 5"
if [ "$with_test" = yes ]; then timed scripts/test.sh; fi
