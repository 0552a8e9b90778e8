# shellcheck shell=bash disable=SC2034
# A Debian 12 root that holds nothing but apt, for scripts that try things there; sourced after lib.sh. What is tried
# lies in its /root/palpate. Of the root as debootstrap leaves it, ~/.cache/palpate keeps a copy for a month. Nothing
# stays mounted.

# Ends the script where no such root can be made.
cannot() {
  note "bare root: skipped, $*"
  exit 77
}

# The first archive of Debian 12 in apt's own list of indexes. apt expands the $(...), not the shell.
# shellcheck disable=SC2016
mirror_of_apt() {
  apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' 2>/dev/null |
    awk '$2 == "bookworm" && !found++ { print $1 }' || true
}

# can_make_roots [MIRROR]: sets `mirror`; ends the script where there can be no root.
can_make_roots() {
  [ "$(id -u)" -eq 0 ] || cannot "it needs root"
  unshare --mount --pid --fork true 2>/dev/null || cannot "root may mount nothing here"
  need_packages fresh
  mirror=${1:-$(mirror_of_apt)}
  if [ -z "$mirror" ]; then
    apt-get update -qq || true
    mirror=$(mirror_of_apt)
  fi
  [ -n "$mirror" ] || cannot "apt has no Debian 12 here: name a mirror"
}

# Debian as debootstrap leaves it: from the copy, if that is whole and not old.
unpack_root() {
  local kept=${XDG_CACHE_HOME:-~/.cache}/palpate/bookworm.tar
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
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

# make_root NAME: a new one, build/NAME, which `root` names from now on.
make_root() {
  root=$PWD/build/$1
  unpack_root
  connect_root
}

# Runs a command in /root/palpate in the root, with /proc and /dev that vanish with it. A folder that `shared` names is
# there as /var/cache/shared.
inside() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc"
    mount --rbind /dev "$0/dev"
    if [ -n "$2" ]; then mkdir -p "$0/var/cache/shared" && mount --bind "$2" "$0/var/cache/shared"; fi
    exec chroot "$0" /usr/bin/env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
      NODE_EXTRA_CA_CERTS=/etc/host-certificates.crt \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      bash -c "cd /root/palpate && $1"' "$root" "$1" "${shared:-}"
}

# timed COMMAND [LOG]: the same, told; what it prints goes to the log, of which the end is shown where it fails.
timed() {
  local started=$SECONDS
  say "in ${root##*/}: $1"
  if [ $# -eq 1 ]; then
    inside "$1" </dev/null
  else
    inside "$1" </dev/null >"$2" 2>&1 || { tail -n 40 "$2" >&2; false; }
  fi || fail "in ${root##*/}: $1; inspect it with: chroot $root"
  note "took $((SECONDS - started)) s: $1"
}
