#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of the documents, deploy/*.jpg, anew with the programs of a build.
set -euo pipefail
cd "$(dirname "$0")/.."

if (($# > 1)) || [[ "${1:-}" == -* ]]; then
  cat <<'TEXT'
Makes the pictures of the documents anew: deploy/*.jpg.

Usage: deploy/pictures.sh [BUILD]

BUILD is the build folder (default build/release). It needs viewloomd and viewloom, and for the
pictures beside the truth also viewloom-bench. The picture of the viewer page needs Chromium.
TEXT
  [[ "${1:-}" == --help || "${1:-}" == -h ]]
  exit
fi

build="${1:-build/release}"
programs=("$build/server/viewloomd" "$build/client/cli/viewloom")
bench="$build/tests/bench/viewloom-bench"
for program in "${programs[@]}"; do
  if [[ ! -x "$program" ]]; then
    echo "pictures: there is no $program; build it with \`ninja -C $build viewloomd viewloom\`" >&2
    exit 2
  fi
done

/usr/bin/python3 deploy/readme_picture.py "${programs[@]}" deploy/three_views.jpg
/usr/bin/python3 deploy/display_pictures.py "${programs[@]}" deploy/displays.jpg
/usr/bin/python3 deploy/reflection_pictures.py "${programs[@]}" deploy/reflections.jpg
if [[ -x /usr/bin/chromium ]]; then
  /usr/bin/python3 deploy/page_picture.py "${programs[@]}" deploy/page.jpg
else
  echo "pictures: there is no /usr/bin/chromium, so the picture of the page stays as it is"
fi
if [[ -x "$bench" ]]; then
  /usr/bin/python3 deploy/application_pictures.py "$bench" deploy
else
  echo "pictures: there is no $bench, so the pictures beside the truth stay as they are"
fi
ls -l deploy/*.jpg
