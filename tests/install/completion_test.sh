#!/usr/bin/env bash
# completion_test.sh FILE: what bash offers for sheen.
set -euo pipefail
source "$1"

# offers EXPECTED WORDS...: the last word is being written.
offers() {
  local expected=$1
  shift
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _sheen
  [[ ${COMPREPLY[*]} == "$expected" ]] || { echo "$*: offered ${COMPREPLY[*]}, not $expected"; exit 1; }
}

offers "register replay resume render" sheen re
offers "auto vertex texel detail" sheen replay --patches ""
offers "mjpeg" sheen capture --format m
offers "--contact-sheet" sheen evaluate model.glb --co
offers "" sheen replay SES  # files are the shell's own business
