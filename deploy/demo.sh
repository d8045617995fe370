#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a bare Debian 12 to a moving light field in the browser: installs, builds, serves, publishes.
set -euo pipefail
cd "$(dirname "$0")/.."

# Size of the published frames: small, for machines without a GPU.
size="${VIEWLOOM_DEMO_SIZE:-480x270}"
rate_hz="${VIEWLOOM_DEMO_RATE:-15}"
log_folder=build/demo
server_pid=
publisher_pid=

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

# Whether the page at port $1 answers with status 200.
page_answers() {
  local status
  exec 3<>"/dev/tcp/127.0.0.1/$1" || return 1
  printf 'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n' >&3
  IFS= read -r -t 5 status <&3 || status=
  exec 3>&-
  [[ "$status" == "HTTP/1.1 200"* ]]
}

# Whoever stands later in the data flow stops first: the server drains while frames still come.
stop() {
  trap - EXIT INT TERM
  local pid
  for pid in $server_pid $publisher_pid; do
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

deploy/setup.sh
cmake --preset release -DVIEWLOOM_TESTS=OFF
cmake --build build/release --parallel "$(nproc)" --target viewloomd viewloom \
  viewloom_python

mkdir -p "$log_folder"
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

grpc_port="$(free_port 50051)"
http_port="$(free_port 8080)"
build/release/server/viewloomd serve --grpc.address "127.0.0.1:$grpc_port" \
  --http.address "127.0.0.1:$http_port" >"$log_folder/viewloomd.log" 2>&1 &
server_pid=$!
until page_answers "$http_port" 2>/dev/null; do
  kill -0 $server_pid 2>/dev/null || give_up "the server ended" "$log_folder/viewloomd.log"
  sleep 0.2
done

build/release/client/cli/viewloom publish --synthetic --size "$size" --rate "$rate_hz" \
  --server "127.0.0.1:$grpc_port" >"$log_folder/publisher.log" 2>&1 &
publisher_pid=$!
sleep 1
kill -0 $publisher_pid 2>/dev/null || give_up "the publisher ended" "$log_folder/publisher.log"

cat <<TEXT

viewloom shows a moving scene ($size at $rate_hz Hz). Open in a browser and move the mouse:

    http://127.0.0.1:$http_port/

Frames come in at 127.0.0.1:$grpc_port (gRPC). Logs are in $log_folder/. Ctrl-C stops both.
TEXT

wait -n $server_pid $publisher_pid || true
kill -0 $server_pid 2>/dev/null || give_up "the server ended" "$log_folder/viewloomd.log"
give_up "the publisher ended" "$log_folder/publisher.log"
