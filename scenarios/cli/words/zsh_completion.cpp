#include "scenarios/cli/words/completion.hpp"

namespace lrb::words {
namespace {

/// Returns text in single quotes, with what _arguments takes for its own escaped.
std::string zsh_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out + "'";
}

std::string zsh_action(const Option& o, const ShippedNames& names) {
  switch (o.value) {
    case Value::none:
      return ": ";
    case Value::choice:
      return o.many ? ":_values -s , value " + joined(o.choices) : ":(" + joined(o.choices) + ")";
    case Value::folder:
      return ":_files -/";
    default: {
      const std::vector<std::string>& known = names.of(o.value);
      if (known.empty()) return ":_files";
      return ":{ compadd -- " + joined(known) + "; _files }";
    }
  }
}

std::string argument_lines(const Command& c, const ShippedNames& names) {
  std::string out;
  std::size_t place = 0;
  for (const Option& o : c.options) {
    if (o.positional) {
      out += " \\\n    '" + (o.many ? std::string("*") : std::to_string(++place)) + ":" + o.names.front() +
             zsh_action(o, names) + "'";
      continue;
    }
    const std::string all = joined(o.names);
    for (const std::string& name : o.names) {
      out += " \\\n    '(" + all + ")'" + name + zsh_quoted("\x01" + o.help);
      const std::size_t help = out.rfind('\x01');
      out.replace(help, 1, "[");
      out.insert(out.size() - 1, "]" + (o.flag() ? "" : ":value" + zsh_action(o, names)));
    }
  }
  return out;
}

/// Writes the function of a command, after those of the commands below it.
void write_zsh(const Command& c, const std::string& function, const ShippedNames& names, std::string& out) {
  for (const Command& below : c.commands) write_zsh(below, function + "_" + below.name, names, out);
  out += function + "() {\n";
  if (c.commands.empty()) {
    out += "  _arguments -s" + argument_lines(c, names) + "\n}\n";
    return;
  }
  out += "  local context state state_descr line\n  typeset -A opt_args\n  _arguments -C" +
         argument_lines(c, names) +
         " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n    command)\n"
         "      local -a commands=(\n";
  for (const Command& below : c.commands)
    out += "        " + zsh_quoted(below.name + "\x02" + below.purpose) + "\n";
  for (std::size_t at = out.find('\x02'); at != std::string::npos; at = out.find('\x02')) out[at] = ':';
  out += "      )\n      _describe command commands\n      ;;\n    argument)\n      case $line[1] in\n";
  for (const Command& below : c.commands)
    out += "        " + below.name + ") " + function + "_" + below.name + " ;;\n";
  out += "      esac\n      ;;\n  esac\n}\n";
}

}  // namespace

std::string zsh_completion(const Command& program, const ShippedNames& names) {
  std::string out =
      "#compdef lrbscope\n# Completion of lrbscope for zsh, written by `lrbscope completion zsh`.\n";
  write_zsh(program, "_lrbscope", names, out);
  return out +
         "if [ \"$funcstack[1]\" = _lrbscope ]; then _lrbscope \"$@\"; else compdef _lrbscope lrbscope; fi\n";
}

}  // namespace lrb::words
