#!/bin/bash
# Plans a request with a running service and prints when robots arrive. Needs curl and jq.
#
#   plan.sh REQUEST.json [URL of the service]
#
# The exit code is 0 if every robot has a plan, 1 if not, and 2 if there is no answer, or an error.
set -euo pipefail
request=${1:?usage: plan.sh REQUEST.json [URL]}
url=${2:-http://localhost:8080}

answer=$(mktemp)
trap 'rm -f "$answer"' EXIT
# The time budget, by default 5 s, and five seconds for all the rest.
seconds=$(jq '(.options.time_budget_ms // 5000) / 1000 + 5' "$request") || exit 2
status=$(curl -sS -o "$answer" -w '%{http_code}' --max-time "$seconds" -H 'Content-Type: application/json' \
  --data-binary @"$request" "$url/v1/plan") || exit 2
if [ "$status" != 200 ]; then
  jq -ers '.[0] | .detail // error, (.errors[]? | "\(.pointer): \(.detail)")' "$answer" >&2 2>/dev/null ||
    echo "$url answers $status; is this a proxy?" >&2
  exit 2
fi
if ! jq -es '.[0] | .plans and .unplanned and .status' "$answer" >/dev/null 2>&1; then
  echo "the answer of $url is no plan; is this a proxy?" >&2
  exit 2
fi

jq -r '(.plans[] | "\(.robot) arrives after \(.cost * 100 | round / 100) s"),
       (.unplanned[] | "\(.robot) has no plan: \(.detail)"),
       "\(.status), flowtime \(.flowtime * 100 | round / 100) s"' "$answer"
jq -e '.status == "solved"' "$answer" >/dev/null
