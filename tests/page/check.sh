#!/usr/bin/env bash
# One check of the viewer's page: check.sh NAME WEB PICTURES PAGE [PROGRAM]. Exit code 77: skipped, and why.
set -euo pipefail
name=$1
export PALPATE_PICTURES=$3 PALPATE_PAGE=$4 PALPATE_PROGRAM=${5:-}
cd "$2"

# Two lines, as other tests that skip say it.
skip() {
  printf 'page/%s: Skipped\n%s\n' "$name" "$1"
  exit 77
}

need_modules() {
  command -v node >/dev/null || skip "node is absent (Debian: nodejs)"
  [ -d node_modules ] || skip "web/node_modules is absent: run npm ci in web"
}

# A snap's chromium sees neither /tmp nor what is built; Ubuntu's /usr/bin/chromium leads to one.
need_browser() {
  [ -x /usr/bin/chromium ] || skip "/usr/bin/chromium is absent (Debian: chromium)"
  case "$(readlink -f /usr/bin/chromium)" in
    */snap*) skip "chromium is a snap, which sees too little of the machine" ;;
  esac
  export CHROMIUM=/usr/bin/chromium
}

need_modules
case "$name" in
  types) npm run --silent check ;;
  lint) npm run --silent lint ;;
  units) npm test --silent ;;
  browser)
    need_browser
    [ -f "$PALPATE_PAGE/index.html" ] || skip "$PALPATE_PAGE is absent: the page was not built"
    npm run --silent browser
    ;;
  tab)
    need_browser
    [ -f "${PALPATE_SITE:-}/tab.wasm" ] || skip "no page of a tab in ${PALPATE_SITE:-PALPATE_SITE}: scripts/tab.sh builds it"
    npm run --silent tab
    ;;
  program | smoke)
    need_browser
    npm run --silent "$name"
    ;;
  *)
    echo "check.sh knows no '$name'" >&2
    exit 2
    ;;
esac
