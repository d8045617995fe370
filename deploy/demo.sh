#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a bare Debian 12 to a moving light field in the browser: installs, builds, serves, publishes.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<'TEXT'
Installs, builds, serves and publishes the portrait scene, for a browser on this machine.

Usage: deploy/demo.sh [--help]

Environment:
  VIEWLOOM_DEMO_SIZE     Size of the frames, such as 600x800 (default: measured at the start)
  VIEWLOOM_DEMO_RATE     Frames a second (default 15)
  VIEWLOOM_DEMO_MIRRORS  on or off: a polished floor, metal balls, and a page with reflections
                         (default: on if the device is a GPU)
TEXT
}

refuse() {
  echo "demo: $1" >&2
  exit 2
}

case "$#,${1:-}" in
  0,) ;;
  1,--help | 1,-h) usage && exit 0 ;;
  *) refuse "unknown argument: $*. Known: --help" ;;
esac

# From small to large, all 3:4 as the display. More pixels than the largest are more than the
# display shows.
sizes=(300x400 360x480 480x640 600x800 720x960 960x1280 1200x1600)
size="${VIEWLOOM_DEMO_SIZE:-}"
rate_hz="${VIEWLOOM_DEMO_RATE:-15}"
mirrors="${VIEWLOOM_DEMO_MIRRORS:-}"
[[ "$mirrors" =~ ^(on|off|)$ ]] || refuse "VIEWLOOM_DEMO_MIRRORS is \"$mirrors\"; say on or off"

log_folder=build/demo
viewloom=build/release/client/cli/viewloom
server_pid=
publisher_pid=
trial_pid=
grpc_port=
http_port=

# The first port from $1 on at which nobody answers.
free_port() {
  local port
  for ((port = $1; port < $1 + 100; ++port)); do
    if ! (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then
      echo "$port"
      return
    fi
  done
  echo "demo: all ports from $1 to $((port - 1)) are taken" >&2
  return 1
}

# Whether the page at port $1 answers with status 200. In a subshell: whoever hangs up at once ends
# it by SIGPIPE.
page_answers() (
  local status
  exec 3<>"/dev/tcp/127.0.0.1/$1" || return 1
  printf 'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n' >&3
  IFS= read -r -t 5 status <&3 || status=
  exec 3>&-
  [[ "$status" == "HTTP/1.1 200"* ]]
)

# Whoever stands later in the data flow stops first: the server drains while frames still come.
stop() {
  trap - EXIT INT TERM
  local pid
  for pid in $server_pid $publisher_pid $trial_pid; do
    kill -TERM "$pid" 2>/dev/null || true
  done
  wait
  echo "demo: stopped"
}

give_up() {
  echo "demo: $1; the end of its log ($2):" >&2
  tail -n 20 "$2" >&2
  exit 1
}

# Starts a server with the options $2..., and waits for its page. Its log is the file $1.
serve() {
  local log="$1"
  shift
  grpc_port="$(free_port 50051)"
  http_port="$(free_port 8080)"
  build/release/server/viewloomd serve --grpc.address "127.0.0.1:$grpc_port" \
    --http.address "127.0.0.1:$http_port" "$@" >"$log" 2>&1 &
  server_pid=$!
  until page_answers "$http_port" 2>/dev/null; do
    kill -0 $server_pid 2>/dev/null || give_up "the server ended" "$log"
    sleep 0.2
  done
}

# Publishes the scene in the size $1 at the rate $2, with the options $3...
publish() {
  local scene_size="$1" scene_rate_hz="$2"
  shift 2
  exec "$viewloom" --server "127.0.0.1:$grpc_port" publish --synthetic --scene portrait \
    --size "$scene_size" --rate "$scene_rate_hz" "$@"
}

# Watches the stream of the trials: three views, $2... for at most $1 seconds.
watch_trial() {
  timeout "$1" "$viewloom" --server "127.0.0.1:$grpc_port" watch trial --quiet \
    --columns 3 --rows 1 --size 1440x640 --cone 2.5 "${@:2}" >>"$log_folder/trial.log" 2>&1
}

# Publishes the stream of the trials in the size $1, with the options $2...
begin_trial() {
  publish "$1" "$trial_rate_hz" --stream trial --quiet "${@:2}" >>"$log_folder/trial.log" 2>&1 &
  trial_pid=$!
}

end_trial() {
  kill -TERM "$trial_pid" 2>/dev/null || true
  wait "$trial_pid" || true
  trial_pid=
}

# Whether the machine keeps frames of the size $1, with one viewer. Publishes for two seconds at
# one and a half times the rate: the rest of the time is the browser's. The viewer has to get four
# fifths of the frames. All of it takes place while the scene moves.
keeps() {
  local wanted begin_ns end_ns
  begin_trial "$1"
  wanted="$(awk -v rate="$trial_rate_hz" 'BEGIN { print int(1.2 * rate) + 2 }')"
  watch_trial 8 --count 2 || true
  begin_ns="$(date +%s%N)"
  watch_trial 3 --count "$wanted" || wanted=0
  end_ns="$(date +%s%N)"
  end_trial
  awk -v count="$wanted" -v rate="$trial_rate_hz" -v ns=$((end_ns - begin_ns)) \
    'BEGIN { exit !((count - 1) * 1e9 >= 0.8 * rate * ns) }'
}

# The largest size that the machine keeps, by halving: three trials of two to three seconds. The
# server of the trials compiles nothing beforehand, because that would take a core from them.
choose_size() {
  local low=0 high=$((${#sizes[@]} - 1)) middle
  trial_rate_hz="$(awk -v rate="$rate_hz" 'BEGIN { print 1.5 * rate }')"
  : >"$log_folder/trial.log"
  serve "$log_folder/trial-viewloomd.log" --pipeline.warm_up false
  # The very first atlas may wait for kernels that a GPU's driver compiles.
  begin_trial "${sizes[0]}" --seconds 0.05 --hold
  watch_trial 30 --count 1 || true
  end_trial
  while ((low < high)); do
    middle=$(((low + high + 1) / 2))
    if keeps "${sizes[middle]}"; then low=$middle; else high=$((middle - 1)); fi
  done
  kill -TERM $server_pid
  wait $server_pid || true
  server_pid=
  size="${sizes[low]}"
  if ((low == ${#sizes[@]} - 1)); then
    reason="the largest of the demo"
  else
    reason="this machine does not keep ${sizes[low + 1]} at $rate_hz Hz beside a browser"
  fi
}

deploy/setup.sh
cmake --preset release -DVIEWLOOM_TESTS=OFF
cmake --build build/release --parallel "$(nproc)" --target viewloomd viewloom \
  viewloom_python

mkdir -p "$log_folder"
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

reason="from VIEWLOOM_DEMO_SIZE"
if [[ -z "$size" ]]; then
  echo "demo: measures which size this machine keeps"
  choose_size
fi
echo "demo: frames have $size pixels: $reason"

serve "$log_folder/viewloomd.log"
# With mirrors, two cores make less than one picture a second while the pointer moves.
if [[ -z "$mirrors" ]]; then
  if grep -Eq 'device: .*(llvmpipe|SwiftShader)' "$log_folder/viewloomd.log"; then
    mirrors=off
  else
    mirrors=on
  fi
fi
page="http://127.0.0.1:$http_port/"
options=()
if [[ "$mirrors" == on ]]; then
  options=(--mirrors)
  # A page with {"preset":"portrait","effects":{"reflection":{"environment_rgb":...}}}: rays that
  # leave the scene meet the colour of its sky.
  page+='?display=%7B%22preset%22:%22portrait%22,%22effects%22:%7B%22reflection%22:'
  page+='%7B%22environment_rgb%22:9413304%7D%7D%7D'
fi

publish "$size" "$rate_hz" "${options[@]}" >"$log_folder/publisher.log" 2>&1 &
publisher_pid=$!
sleep 1
kill -0 $publisher_pid 2>/dev/null || give_up "the publisher ended" "$log_folder/publisher.log"

scene="$size at $rate_hz Hz, mirrors $mirrors"
cat <<TEXT

viewloom shows a moving scene: $scene. Open in a browser and move the mouse:

    $page

The scene moves for 15 s and stands for 5 s. While it stands, the page shows it sharp.
Frames come in at 127.0.0.1:$grpc_port (gRPC). Logs are in $log_folder/. Ctrl-C stops both.
TEXT

wait -n $server_pid $publisher_pid || true
kill -0 $server_pid 2>/dev/null || give_up "the server ended" "$log_folder/viewloomd.log"
give_up "the publisher ended" "$log_folder/publisher.log"
