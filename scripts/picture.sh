#!/usr/bin/env bash
# Redraws the picture of the README, with the program as it is.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"

if [ $# -gt 0 ]; then
  sed -n '2s/^# //p' "$0"
  exit
fi
need_packages build picture
if [ ! -f build/release/CMakeCache.txt ]; then configure release -DPALPATE_BUILD_TESTS=OFF; fi
build release palpate_app
mkdir -p docs/images
build/release/apps/palpate/palpate touch synthetic:bumps --picture docs/images/touch.png
# Fewer colours make a quarter of the bytes.
/usr/bin/python3 -c '
from PIL import Image
image = Image.open("docs/images/touch.png").convert("RGB")
image = image.resize((image.width * 2 // 3, image.height * 2 // 3), Image.LANCZOS)
image.quantize(128, dither=Image.Dither.NONE).save("docs/images/touch.png", optimize=True)
'
note "docs/images/touch.png: $(stat -c %s docs/images/touch.png) bytes"
