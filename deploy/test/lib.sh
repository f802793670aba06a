# shellcheck shell=bash
# Shared by the tests in this folder: requirements, the image, containers that run as in production, checks.
# Sourced by bash with `set -euo pipefail`. Exit codes: 0 passed, 1 failed, 77 skipped.

HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
ROOT=$(cd "$HERE/../.." && pwd -P)
NAME=fleetplan-test                              # of everything that is created here
IMAGE=${FLEETPLAN_IMAGE:-$NAME}                  # an existing image, or the one that is built here
DEBIAN_SUITE=${DEBIAN_SUITE:-trixie}
FAILED=0

say() { printf '%s\n' "$*" >&2; }
skip() { say "SKIPPED ${0##*/}: $*"; exit 77; }
die() { say "FAILED ${0##*/}: $*"; exit 1; }

# check DESCRIPTION COMMAND...: reports whether the command succeeds, and continues.
check() {
  if "${@:2}"; then
    printf 'ok      %s\n' "$1"
  else
    printf 'FAILED  %s\n' "$1"
    FAILED=$((FAILED + 1))
  fi
}

figure() { printf 'figure  %s\n' "$*"; }

# conclude: the exit code of the test by its checks.
conclude() { [ "$FAILED" = 0 ] || die "$FAILED checks failed"; }

# await SECONDS COMMAND...: repeats the command until it succeeds.
await() {
  local end=$((SECONDS + $1))
  until "${@:2}"; do
    [ "$SECONDS" -lt "$end" ] || return 1
    sleep 0.2
  done
}

# ---------------------------------------------------------------- requirements

need_commands() {
  local command
  for command in "$@"; do
    command -v "$command" >/dev/null || skip "$command is not installed"
  done
}

need_engine() {
  need_commands docker curl python3
  docker version >/dev/null 2>&1 || skip "no Docker engine responds (DOCKER_HOST=${DOCKER_HOST:-})"
}

# need_compose: finds Docker Compose; then `compose ARGUMENTS` runs it with the project and image of the tests.
need_compose() {
  if docker compose version >/dev/null 2>&1; then
    COMPOSE=(docker compose)
  elif command -v docker-compose >/dev/null; then
    COMPOSE=(docker-compose)
  else
    skip "Docker Compose is not installed"
  fi
}

compose() {
  FLEETPLAN_IMAGE=$IMAGE FLEETPLAN_PUBLISH=127.0.0.1:0 PROMETHEUS_PUBLISH=127.0.0.1:0 \
    "${COMPOSE[@]}" -p "$NAME" -f "$ROOT/deploy/compose.yaml" "$@"
}

# ---------------------------------------------------------------- images

has_image() { docker image inspect "$1" >/dev/null 2>&1 || docker pull -q "$1" >/dev/null 2>&1; }

# need_base: pulls debian:SUITE-slim, or makes it with debootstrap if no registry has it.
need_base() {
  local base=debian:$DEBIAN_SUITE-slim folder mirror
  has_image "$base" && return 0
  if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
    skip "$base cannot be pulled; making it needs root and debootstrap"
  fi
  say "making $base"
  folder=$(mktemp -d)
  # shellcheck disable=SC2016
  mirror=$(apt-get indextargets --format '$(SITE)' | sed -n 1p)
  debootstrap --variant=minbase "$DEBIAN_SUITE" "$folder" "$mirror" >"$folder.log" 2>&1 || die "see $folder.log"
  cp -r /etc/apt/apt.conf.d/. "$folder/etc/apt/apt.conf.d/"  # how to reach the mirror
  rm -rf "$folder"/var/cache/apt/archives/*.deb "$folder"/var/lib/apt/lists/*
  tar -C "$folder" --exclude='./dev/*' -c . | docker import - "$base" >/dev/null
  rm -rf --one-file-system "$folder" "$folder.log"
}

# need_image: builds the image to test, unless FLEETPLAN_IMAGE names it. It uses the network of the host for engines
# whose containers have no outgoing network.
need_image() {
  [ -z "${FLEETPLAN_IMAGE:-}" ] || return 0
  need_base
  say "building the image $IMAGE on $DEBIAN_SUITE; this takes minutes, unless it was built before"
  docker build --network host --build-arg "DEBIAN_SUITE=$DEBIAN_SUITE" -t "$IMAGE" "$ROOT" >"/tmp/$NAME.build.log" 2>&1 ||
    { tail -n 30 "/tmp/$NAME.build.log" >&2; die "the image cannot be built"; }
}

# need_package_image IMAGE PACKAGE ENTRYPOINT DATA: if no registry has the image, makes one under its name from the
# Debian package of the same program, with a folder for data.
need_package_image() {
  has_image "$1" && return 0
  need_base
  say "making $1 from the Debian package $2"
  docker build --network host -q -t "$1" - >"/tmp/$NAME.build.log" 2>&1 <<EOF || die "see /tmp/$NAME.build.log"
FROM debian:$DEBIAN_SUITE-slim
RUN apt-get -q update && apt-get -q -y install --no-install-recommends $2 && install -d -o 65534 -g 65534 $4
USER 65534:65534
ENTRYPOINT $3
EOF
}

compose_image() { sed -n "s|^    image: \($1.*\)|\1|p" "$ROOT/deploy/compose.yaml"; }
need_haproxy() { need_package_image "$(compose_image haproxy)" haproxy '[]' /var/lib/haproxy; }
need_prometheus() { need_package_image "$(compose_image prom/prometheus)" prometheus '["/usr/bin/prometheus"]' /prometheus; }

# ---------------------------------------------------------------- single containers

# run NAME [OPTIONS OF DOCKER...]: starts a container of the image, as in production, on the network of the tests.
run() {
  docker network inspect "$NAME" >/dev/null 2>&1 || docker network create "$NAME" >/dev/null
  docker run -d --name "$NAME-$1" --label "$NAME" --network "$NAME" --network-alias "$1" --read-only --cap-drop ALL \
    --security-opt no-new-privileges --publish 127.0.0.1::8080 --publish 127.0.0.1::8081 "${@:2}" "$IMAGE" >/dev/null
}

# port NAME PORT: the port of this machine that a container's port is published on.
port() { docker port "$NAME-$1" "$2" | sed -n '1s/.*://p'; }

url() { printf 'http://127.0.0.1:%s' "$(port "$1" "${2:-8080}")"; }

remove() { docker rm -f "$NAME-$1" >/dev/null; }

# ---------------------------------------------------------------- the stack of compose.yaml

REPLICAS=(fleetplan-1 fleetplan-2 fleetplan-3)

container() { compose ps -q "$1"; }

# start_stack [SERVICE...]: starts the replicas, the balancer and the named services, and waits until all replicas are
# healthy and the balancer uses them.
start_stack() {
  local replica
  compose up -d "${REPLICAS[@]}" balancer "$@" >/dev/null 2>&1 || die "the stack does not start"
  for replica in "${REPLICAS[@]}"; do
    await 60 healthy "$(container "$replica")" || die "$replica does not become healthy"
  done
  BALANCER=$(compose port balancer 8000)
  BALANCER_PORT=${BALANCER##*:}
  await 60 balanced 3 || die "the balancer does not use the replicas"
}

# metrics SERVICE PORT: the metrics of a service, from inside the network of the stack.
metrics() {
  local address
  address=$(docker inspect -f '{{range .NetworkSettings.Networks}}{{.IPAddress}}{{end}}' "$(container "$1")")
  curl -s "http://$address:$2/metrics"
}

# balancer_metric NAME: the value for the backend of the balancer.
balancer_metric() { metrics balancer 8404 | sed -n "s/^$1{proxy=\"replicas\"} //p"; }

# balanced COUNT: succeeds if the balancer uses this number of replicas.
balanced() { [ "$(balancer_metric haproxy_backend_active_servers)" = "$1" ]; }

# start_load ARGUMENTS...: runs load.py in the background; end_load prints its result and fails if a request failed.
start_load() {
  LOAD_RESULT=$(mktemp)
  python3 "$HERE/load.py" --port "$BALANCER_PORT" "$@" >"$LOAD_RESULT" &
  LOAD=$!
}

end_load() {
  local status=0
  kill -TERM "$LOAD" 2>/dev/null || true
  wait "$LOAD" || status=$?
  figure "load: $(cat "$LOAD_RESULT")"
  rm -f "$LOAD_RESULT"
  return "$status"
}

# ---------------------------------------------------------------- in general

# remove_all: removes everything of these tests except the images.
remove_all() {
  local containers
  containers=$(docker ps -aq --filter "label=$NAME")
  [ -z "$containers" ] || xargs docker rm -f <<<"$containers" >/dev/null
  [ -z "${COMPOSE:-}" ] || compose down -v >/dev/null 2>&1
  docker network rm "$NAME" >/dev/null 2>&1 || true
}

answers() { curl -fsS -o /dev/null "$1" 2>/dev/null; }

healthy() { [ "$(docker inspect -f '{{.State.Health.Status}}' "$1")" = healthy ]; }

# json EXPRESSION: a Python expression of the JSON on stdin, which is `it`; prints strings without quotes.
json() {
  python3 -c "import json, sys; it = json.load(sys.stdin); x = $1; print(x if isinstance(x, str) else json.dumps(x))"
}
