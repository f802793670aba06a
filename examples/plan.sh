#!/bin/bash
# Plans a request with a running service and prints when robots arrive. Needs curl and jq.
#
#   plan.sh REQUEST.json [URL of the service]
#
# The exit code is 0 if every robot has a plan.
set -euo pipefail
request=${1:?usage: plan.sh REQUEST.json [URL]}
url=${2:-http://localhost:8080}

answer=$(mktemp)
trap 'rm -f "$answer"' EXIT
status=$(curl -sS -o "$answer" -w '%{http_code}' -H 'Content-Type: application/json' \
  --data-binary @"$request" "$url/v1/plan")
if [ "$status" != 200 ]; then
  jq -r '.detail, (.errors[]? | "\(.pointer): \(.detail)")' "$answer" >&2
  exit 2
fi

jq -r '(.plans[] | "\(.robot) arrives after \(.cost * 100 | round / 100) s"),
       (.unplanned[] | "\(.robot) has no plan: \(.detail)"),
       "\(.status), flowtime \(.flowtime * 100 | round / 100) s"' "$answer"
jq -e '.status == "solved"' "$answer" >/dev/null
