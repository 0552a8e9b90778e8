#!/bin/sh
# Every type by others' definitions, decoder and encoder: others_types.sh PRINT_TYPES PEER. Exits with 77 where node, or what
# the folder PEER needs of npm, is absent.
set -eu
node --version >/dev/null 2>&1 || { echo "node is absent (Debian: nodejs)"; exit 77; }
[ -e "$2/node_modules/.package-lock.json" ] || { echo "run npm ci in $2"; exit 77; }
types=$(mktemp)
trap 'rm -f "$types"' EXIT
"$1" >"$types"
node "$2/types.mjs" <"$types"
