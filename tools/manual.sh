#!/bin/sh
# manual.sh LRBSCOPE FOLDER: writes the manual pages of the program and of all its commands, from their --help, by help2man.
set -eu
version=$("$1" --version | sed 's/^lrbscope //')
mkdir -p "$2"

# pages COMMAND...: those of a command and of the commands below it.
pages() {
  help=$("$program" "$@" --help)
  name=$(printf '%s\n' lrbscope "$@" | paste -sd-)
  # The first paragraph of --help is the purpose.
  purpose=$(printf '%s\n' "$help" | sed '/^Usage:/Q; /^$/Q' | paste -sd' ' | sed 's/[. ]*$//')
  set -- "$program" "$@"
  help2man --no-info --no-discard-stderr --name="$purpose" --version-string="$version" --source="lrbscope $version" \
    --include="$here/manual.h2m" --output="$folder/$name.1" "$*"
  # help2man names the page of a subcommand after the program.
  sed -i "s/^\.TH LRBSCOPE/.TH $(printf %s "$name" | tr a-z A-Z)/; /^\.SH NAME/,/^\.SH SYNOPSIS/s/^lrbscope .*\\\\- /$name \\\\- /" "$folder/$name.1"
  shift
  for below in $(printf '%s\n' "$help" | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p'); do (pages "$@" "$below"); done
}
here=$(dirname "$0") program=$1 folder=$2
pages
