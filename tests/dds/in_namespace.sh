#!/bin/sh
# Runs a Python script in a network namespace of its own: in_namespace.sh SCRIPT ARGUMENT... Exits 77 where none can be had.
if ! unshare -rn true 2>/dev/null; then
  echo "no network namespace can be made here (unshare -rn)"
  exit 77
fi
exec unshare -rn python3 "$@"
