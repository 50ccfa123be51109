#include "scenarios/cli/words/completion.hpp"

namespace lrb::words {
namespace {

std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

/// Returns the words that say what a value is.
std::string fish_action(const Option& o, const ShippedNames& names) {
  switch (o.value) {
    case Value::none:
      return " -x";
    case Value::choice:
      return " -x -a " + fish_quoted(joined(o.choices));
    case Value::folder:
      return " -x -a '(__fish_complete_directories)'";
    default: {
      const std::vector<std::string>& known = names.of(o.value);
      return " -r -F" + (known.empty() ? "" : " -a " + fish_quoted(joined(known)));
    }
  }
}

void write_fish(const Command& c, const std::string& condition, const ShippedNames& names, std::string& out) {
  const std::string begin =
      "complete -c lrbscope" + (condition.empty() ? "" : " -n " + fish_quoted(condition));
  for (const Option& o : c.options) {
    if (o.positional) {
      const std::vector<std::string>& known = names.of(o.value);
      out += begin + " -F" + (known.empty() ? "" : " -a " + fish_quoted(joined(known))) + "\n";
      continue;
    }
    out += begin;
    for (const std::string& name : o.names)
      out += name.substr(0, 2) == "--" ? " -l " + name.substr(2) : " -s " + name.substr(1);
    out += (o.flag() ? "" : fish_action(o, names)) + " -d " + fish_quoted(o.help) + "\n";
  }
  if (c.commands.empty()) return;
  std::string all;
  for (const Command& below : c.commands) all += " " + below.name;
  const std::string none =
      condition.empty() ? "__fish_use_subcommand" : condition + "; and not __fish_seen_subcommand_from" + all;
  for (const Command& below : c.commands) {
    out += "complete -c lrbscope -n " + fish_quoted(none) + " -f -a " + below.name + " -d " +
           fish_quoted(below.purpose) + "\n";
    const std::string seen = "__fish_seen_subcommand_from " + below.name;
    write_fish(below, condition.empty() ? seen : condition + "; and " + seen, names, out);
  }
}

}  // namespace

std::string fish_completion(const Command& program, const ShippedNames& names) {
  std::string out =
      "# Completion of lrbscope for fish, written by `lrbscope completion fish`.\ncomplete -c lrbscope -f\n";
  write_fish(program, "", names, out);
  return out;
}

}  // namespace lrb::words
