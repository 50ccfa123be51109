#include "scenarios/cli/words/completion.hpp"

namespace lrb::words {
namespace {

/// What the script does with the tables before it. COMP_WORDS has "=" as a word of its own.
constexpr const char* kDriver = R"sh(
_lrbscope() {
  local cur=${COMP_WORDS[COMP_CWORD]} path="" previous="" word i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    case " $(_lrbscope_commands "$path") " in *" $word "*) path+="${path:+ }$word" ;; esac
    [ "$word" = = ] || previous=$word
  done
  [ "$cur" != = ] || cur=""
  local what=""
  [[ $previous != -* ]] || what=$(_lrbscope_value "$path" "$previous")
  COMPREPLY=()
  if [ -z "$what" ]; then
    if [[ $cur == -* ]]; then
      COMPREPLY=($(compgen -W "$(_lrbscope_options "$path")" -- "$cur"))
      return
    fi
    local commands
    commands=$(_lrbscope_commands "$path")
    if [ -n "$commands" ]; then
      COMPREPLY=($(compgen -W "$commands" -- "$cur"))
      return
    fi
    what=$(_lrbscope_argument "$path")
  fi
  local IFS=$'\n'
  case "$what" in
    none | "") ;;
    folder)
      compopt -o filenames 2>/dev/null
      COMPREPLY=($(compgen -d -- "$cur"))
      ;;
    file*)
      compopt -o filenames 2>/dev/null
      COMPREPLY=($(compgen -f -- "$cur"; IFS=' '; compgen -W "${what#file}" -- "$cur"))
      ;;
    choice*)
      local before=""
      [[ $cur != *,* ]] || before=${cur%,*},
      IFS=' '
      local chosen
      chosen=$(compgen -W "${what#choice}" -P "$before" -- "${cur##*,}")
      IFS=$'\n'
      COMPREPLY=($chosen)
      ;;
  esac
}
complete -F _lrbscope lrbscope
)sh";

/// Returns what the script is to do for a value: "none", "folder", "file NAMES" or "choice WORDS".
std::string bash_action(const Option& o, const ShippedNames& names) {
  switch (o.value) {
    case Value::none:
      return "none";
    case Value::choice:
      return "choice " + joined(o.choices);
    case Value::folder:
      return "folder";
    default:
      return "file " + joined(names.of(o.value));
  }
}

struct Tables {
  std::string commands, options, values, arguments;
};

void fill_tables(const Command& c, const std::string& path, const Command& program, const ShippedNames& names,
                 Tables& out) {
  const std::string label = "    \"" + path + "\") echo \"";
  std::string list;
  for (const Command& below : c.commands) list += (list.empty() ? "" : " ") + below.name;
  if (!list.empty()) out.commands += label + list + "\" ;;\n";
  list.clear();
  std::vector<const Option*> all;
  for (const Option& o : c.options) all.push_back(&o);
  if (&c != &program)
    for (const Option& o : program.options)
      if (!o.positional && o.names.back() != "--help" && o.names.back() != "--version") all.push_back(&o);
  bool has_argument = false;
  for (const Option* o : all) {
    if (o->positional) {
      if (!has_argument) out.arguments += label + bash_action(*o, names) + "\" ;;\n";
      has_argument = true;
      continue;
    }
    for (const std::string& name : o->names) {
      list += (list.empty() ? "" : " ") + name;
      if (!o->flag())
        out.values += "    \"" + path + " " + name + "\") echo \"" + bash_action(*o, names) + "\" ;;\n";
    }
  }
  out.options += label + list + "\" ;;\n";
  for (const Command& below : c.commands)
    fill_tables(below, path.empty() ? below.name : path + " " + below.name, program, names, out);
}

std::string table(const char* name, const char* what, const std::string& lines) {
  return std::string("_lrbscope_") + name + "() {\n  case \"" + what + "\" in\n" + lines + "  esac\n}\n";
}

}  // namespace

const std::vector<std::string>& ShippedNames::of(Value value) const {
  static const std::vector<std::string> kNone;
  switch (value) {
    case Value::scenario:
      return scenarios;
    case Value::crowd:
      return crowds;
    case Value::experiment:
      return experiments;
    default:
      return kNone;
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

std::string bash_completion(const Command& program, const ShippedNames& names) {
  Tables t;
  fill_tables(program, "", program, names, t);
  return "# Completion of lrbscope for bash, written by `lrbscope completion bash`.\n" +
         table("commands", "$1", t.commands) + table("options", "$1", t.options) +
         table("value", "$1 $2", t.values) + table("argument", "$1", t.arguments) + (kDriver + 1);
}

}  // namespace lrb::words
