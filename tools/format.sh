#!/usr/bin/env bash
# Formats all sources; with --check changes nothing and lists what is not formatted.
set -euo pipefail
cd -P -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

tool=$(command -v clang-format-14 || command -v clang-format || true)
if [ -z "$tool" ]; then
  echo "tools/format.sh: clang-format was not found; install version 14 (Debian: clang-format-14)" >&2
  exit 2
fi
if ! "$tool" --version | grep -q 'version 14\.'; then
  echo "tools/format.sh: expected clang-format 14, which formats as the project does; found: $("$tool" --version)" >&2
  exit 2
fi

sources() {
  find include src io render apps bench tests examples -type f \( -name '*.h' -o -name '*.cpp' \) -print0 2>/dev/null
}
case ${1:-} in
  "") sources | xargs -0 -r "$tool" -i ;;
  --check)
    if ! sources | xargs -0 -r "$tool" --dry-run -Werror --ferror-limit=1; then
      echo "not formatted as .clang-format says; remedy: tools/format.sh" >&2
      exit 1
    fi
    ;;
  *) echo "usage: tools/format.sh [--check]" >&2; exit 2 ;;
esac
