#!/usr/bin/env bash
# The check of action.yml: annotations in the log, a SARIF file, the step summary and the outputs of the step.
set -euo pipefail

work=${RUNNER_TEMP:?}/ros-lint
mkdir -p "$work"
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check "${ROS_LINT_PACKAGE:-$ROS_LINT_ACTION}"

arguments=()
for text in "${ROS_LINT_PATH:-.}" "${ROS_LINT_ARGS:-}"; do
  while IFS= read -r line; do
    [ -z "$line" ] || arguments+=("$line")
  done <<< "$text"
done
[ -z "${ROS_LINT_DISTRO:-}" ] || arguments+=(--distro "$ROS_LINT_DISTRO")
[ -z "${ROS_LINT_FAIL_ON:-}" ] || arguments+=(--fail-on "$ROS_LINT_FAIL_ON")

sarif=$work/ros-lint.sarif
summary=$work/summary.md
code=0
"$work/venv/bin/ros-lint" "${arguments[@]}" --format github --output "sarif:$sarif" --output "markdown:$summary" || code=$?
[ ! -s "$sarif" ] || echo "sarif-file=$sarif" >> "${GITHUB_OUTPUT:?}"
# GitHub rejects summaries of more than 1 MiB.
if [ -s "$summary" ] && [ "$(wc -c < "$summary")" -lt 1000000 ]; then
  cat "$summary" >> "${GITHUB_STEP_SUMMARY:?}"
fi
echo "exit-code=$code" >> "${GITHUB_OUTPUT:?}"
