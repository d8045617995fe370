#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the image of deploy/Containerfile with podman or docker, and asks its server what it can do.
set -euo pipefail
cd "$(dirname "$0")/../.."
image=viewloom-under-test

engine=
for candidate in podman docker; do
  if "$candidate" info >/dev/null 2>&1; then
    engine="$candidate"
    break
  fi
done
if [[ -z "$engine" ]]; then
  echo "container: neither podman nor docker answers; install one (\`apt-get install podman\`) and start it" >&2
  exit 1
fi

format=()
[[ "$engine" != podman ]] || format=(--format docker)
"$engine" build "${format[@]}" -f deploy/Containerfile -t "$image" .
trap '"$engine" rm --force "$image" >/dev/null; "$engine" rmi "$image" >/dev/null' EXIT

user="$("$engine" run --rm --entrypoint id "$image" --user)"
[[ "$user" -ne 0 ]] || { echo "container: the server runs as root" >&2; exit 1; }
"$engine" run --rm "$image" doctor
"$engine" run --detach --name "$image" --read-only --cap-drop ALL \
  --security-opt no-new-privileges "$image"
for _ in $(seq 30); do
  health="$("$engine" inspect --format '{{.State.Health.Status}}' "$image")"
  if [[ "$health" == healthy ]]; then
    echo "container: $engine built the image, and its server is healthy"
    exit 0
  fi
  sleep 2
done
"$engine" logs "$image" >&2
echo "container: the server is $health after a minute" >&2
exit 1
