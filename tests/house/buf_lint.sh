#!/bin/sh
# buf_lint.sh ROOT: the contract keeps the rules of buf.yaml.
set -eu
cd "$1"
buf=build/tools/node_modules/.bin/buf
if [ ! -x "$buf" ]; then
  echo "buf is not installed: run ./dev setup" >&2
  exit 1
fi
"$buf" lint
