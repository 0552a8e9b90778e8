#!/usr/bin/env bash
# Takes the pictures of README and documents, with the program as it is: scripts/picture.sh [contact] [page]
# Both, if none is named; page: in Chromium, also ten seconds of moving picture. Look at them: a busy machine shows.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"

if [ $# -eq 0 ]; then set -- contact page; fi
for part in "$@"; do
  case $part in
    contact | page) ;;
    *) sed -n '2,3s/^# //p' "$0"; exit ;;
  esac
done

need_packages build viewer
need_npm
if [ ! -f build/release/CMakeCache.txt ]; then configure release -DPALPATE_BUILD_TESTS=OFF; fi
build release palpate_app
program=$PWD/build/release/apps/palpate/palpate
mkdir -p docs/images

picture_contact() {
  need_packages picture
  "$program" touch synthetic:bumps --picture docs/images/touch.png
  # Fewer colours make a quarter of the bytes.
  /usr/bin/python3 -c '
from PIL import Image
image = Image.open("docs/images/touch.png").convert("RGB")
image = image.resize((image.width * 2 // 3, image.height * 2 // 3), Image.LANCZOS)
image.quantize(128, dither=Image.Dither.NONE).save("docs/images/touch.png", optimize=True)
'
  note "docs/images/touch.png: $(stat -c %s docs/images/touch.png) bytes"
}

picture_page() {
  need_browser
  need_modules web
  (cd web && export PALPATE_PROGRAM=$program && npm run --silent pictures && npm run --silent moving)
}

for part in "$@"; do "picture_$part"; done
