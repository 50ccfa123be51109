/// Texts generated from the program's option definitions: shell completions and manual pages.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::completion {
namespace {

// The commands and options of a program as data, taken from the definitions that parse them.

/// Source of completions for a value.
enum class Value : std::uint8_t { none, choice, file, folder, scenario, crowd, experiment };

struct Option {
  std::vector<std::string> names;  ///< "-o", "--output"; for a positional one only its name
  std::string type;                ///< as in --help: "DIR", "N", "a|b"; empty: a flag
  std::string help;
  std::string fallback;  ///< the default value; empty: none shown
  bool positional = false, required = false;
  bool many = false;  ///< accepts several values
  Value value = Value::none;
  std::vector<std::string> choices;

  bool flag() const { return !positional && type.empty(); }
};

struct Command {
  std::string name, purpose;
  std::vector<Option> options;
  std::vector<Command> commands;
};

/// Returns the choices of a type such as "png|svg" or "answers,events", or an empty list for another type.
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> out(1);
  for (const char c : type) {
    if (c == '|' || c == ',')
      out.emplace_back();
    else if (std::islower(static_cast<unsigned char>(c)) != 0 ||
             std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '_')
      out.back() += c;
    else
      return {};
  }
  const bool whole = std::none_of(out.begin(), out.end(), [](const std::string& w) { return w.empty(); });
  return whole && out.size() > 1 ? out : std::vector<std::string>();
}

/// Returns the source of completions for a value, from the value names that commands use.
Value value_of(const std::string& type, const std::string& name, bool positional) {
  const std::string word = type.substr(0, type.find_first_of(":= "));
  if (!choices_of(word).empty()) return Value::choice;
  if (positional && (name == "SCENARIO" || name == "SOURCE" || name == "INPUT")) return Value::scenario;
  if (positional && name == "CROWD") return Value::crowd;
  if (word == "NAME|FILE") return Value::experiment;
  if (word == "DIR" || word == "FOLDER") return Value::folder;
  const bool names_file = word.find("FILE") != std::string::npos || word.find('.') != std::string::npos ||
                          word == "PNG" || word.find("PATH") != std::string::npos;
  // A value type "TEXT" without further choices is a file in this program.
  return names_file || word == "TEXT" ? Value::file : Value::none;
}

Option option_of(const CLI::Option& o) {
  Option out;
  out.positional = o.get_positional() && o.get_lnames().empty() && o.get_snames().empty();
  for (const std::string& name : o.get_snames()) out.names.push_back("-" + name);
  for (const std::string& name : o.get_lnames()) out.names.push_back("--" + name);
  if (out.positional) out.names = {o.get_name(true, false)};
  out.help = o.get_description();
  out.required = o.get_required();
  if (o.get_items_expected_max() == 0) return out;
  out.type = o.get_type_name();
  out.fallback = o.get_default_str();
  out.many = o.get_items_expected_max() > 1;
  out.value = value_of(out.type, out.names.front(), out.positional);
  out.choices = choices_of(out.type.substr(0, out.type.find_first_of(":= ")));
  return out;
}

/// Returns the words of a program or command, without hidden ones.
Command command_of(const CLI::App& app) {
  Command out;
  out.name = app.get_name();
  out.purpose = app.get_description();
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); }))
    out.options.push_back(option_of(*option));
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
    out.commands.push_back(command_of(*command));
  return out;
}

/// Returns the words with a blank between them.
std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

// Shell scripts.

/// Names accepted instead of a file path.
struct ShippedNames {
  std::vector<std::string> scenarios, crowds, experiments;
  const std::vector<std::string>& of(Value value) const;  ///< empty for other values
};

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

/// The script's code, which follows the tables. COMP_WORDS has "=" as a separate word.
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

/// Returns the script's action for a value: "none", "folder", "file NAMES" or "choice WORDS".
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

std::string bash_completion(const Command& program, const ShippedNames& names) {
  Tables t;
  fill_tables(program, "", program, names, t);
  return "# Completion of lrbscope for bash, written by `lrbscope completion bash`.\n" +
         table("commands", "$1", t.commands) + table("options", "$1", t.options) +
         table("value", "$1 $2", t.values) + table("argument", "$1", t.arguments) + (kDriver + 1);
}

std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

/// Returns the fish arguments that complete a value.
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

std::string fish_completion(const Command& program, const ShippedNames& names) {
  std::string out =
      "# Completion of lrbscope for fish, written by `lrbscope completion fish`.\ncomplete -c lrbscope -f\n";
  write_fish(program, "", names, out);
  return out;
}

/// Returns text in single quotes, with the special characters of _arguments escaped.
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

/// Writes the function of a command, after those of its subcommands.
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

std::string zsh_completion(const Command& program, const ShippedNames& names) {
  std::string out =
      "#compdef lrbscope\n# Completion of lrbscope for zsh, written by `lrbscope completion zsh`.\n";
  write_zsh(program, "_lrbscope", names, out);
  return out +
         "if [ \"$funcstack[1]\" = _lrbscope ]; then _lrbscope \"$@\"; else compdef _lrbscope lrbscope; fi\n";
}

// Manual pages.

/// Returns text escaped for roff: hyphens stay copyable, and no line is a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\n')
      out += ' ';
    else
      out += c;
  }
  if (!out.empty() && (out[0] == '.' || out[0] == '\'')) out.insert(0, "\\&");
  return out;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
  return text;
}

std::string heading(const std::string& name, const std::string& version) {
  return ".TH " + upper(name) + " 1 \"\" \"lrbscope " + version + "\" \"lrbscope\"\n";
}

/// Returns "NAME...", in square brackets if it is optional.
std::string usage_of(const Option& o) {
  const std::string name = "\\fI" + roff(o.names.front()) + "\\fR" + (o.many ? "..." : "");
  return o.required ? name : "[" + name + "]";
}

std::string synopsis(const std::string& call, const Command& c) {
  std::string out = ".B " + roff(call) + "\n";
  for (const Option& o : c.options)
    if (!o.positional && o.required)
      out += "\\fB" + roff(o.names.back()) + "\\fR \\fI" + roff(o.type) + "\\fR\n";
  out += "[\\fIOPTIONS\\fR]\n";
  if (!c.commands.empty()) out += "\\fICOMMAND\\fR ...\n";
  for (const Option& o : c.options)
    if (o.positional) out += usage_of(o) + "\n";
  return out;
}

std::string paragraph(const Option& o) {
  std::string out = ".TP\n";
  for (std::size_t i = 0; i < o.names.size(); ++i) {
    if (i > 0) out += ", ";
    out += (o.positional ? "\\fI" : "\\fB") + roff(o.names[i]) + "\\fR";
  }
  if (!o.positional && !o.type.empty()) out += " \\fI" + roff(o.type) + "\\fR";
  out += "\n" + roff(o.help.empty() ? "See lrbscope(1)" : o.help);
  if (!o.fallback.empty()) out += roff(" [" + o.fallback + "]");
  return out + (o.required ? ". Required.\n" : ".\n");
}

/// Returns the sections of a command's arguments and options.
std::string options_of(const Command& c, const std::string& section) {
  std::string arguments, options;
  for (const Option& o : c.options) (o.positional ? arguments : options) += paragraph(o);
  std::string out;
  if (!arguments.empty()) out += section + " \"ARGUMENTS\"\n" + arguments;
  if (!options.empty()) out += section + " \"OPTIONS\"\n" + options;
  return out;
}

/// Returns a sentence without its full stop, as in headings of manual pages.
std::string title_of(std::string purpose) {
  while (!purpose.empty() && purpose.back() == '.') purpose.pop_back();
  if (!purpose.empty()) purpose[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(purpose[0])));
  return purpose;
}

constexpr std::string_view kExitStatus =
    ".SH \"EXIT STATUS\"\n.TP\n0\nSuccess.\n.TP\n1\nMismatch: an expectation, a golden run or a validation "
    "failed.\n.TP\n2\nUsage or input error; one line on stderr names the location.\n.TP\n3\nMissing "
    "dependency or resource: memory, disk space, a package.\n";

struct Variable {
  std::string_view name, help;
};
constexpr std::array kVariables = {
    Variable{"LRB_FONT", "Font file for text in pictures, if DejaVu Sans is not installed."},
    Variable{"LRB_GL",
             "osmesa or egl: the library that draws pictures. Default: OSMesa if it is installed, otherwise "
             "EGL."},
    Variable{"LRB_SIMD", "avx2 or baseline: use the kernels for older processors. Results do not change."},
    Variable{"LRBSCOPE_METHODS", "Folder with the worker programs of other engines."},
    Variable{"NO_COLOR", "If set, progress is drawn without colours."}};

/// Returns the manual page (roff, section 1) of a program: its commands, options, exit codes and environment.
std::string program_page(const Command& program, const std::string& version) {
  std::string out = heading(program.name, version);
  out += ".SH NAME\n" + roff(program.name) + " \\- " + roff(title_of(program.purpose)) + "\n";
  out += ".SH SYNOPSIS\n" + synopsis(program.name, program);
  out +=
      ".SH DESCRIPTION\nFinds all intersecting pairs of faces of two bodies, exactly, for bodies of any "
      "shape. Every comparison and\nevery refinement of a query can be recorded, replayed and drawn. Results "
      "are printed to stdout, notes and\nerrors to stderr.\n";
  out += ".SH COMMANDS\n";
  for (const Command& c : program.commands)
    out += ".TP\n.B " + roff(c.name) + "\n" + roff(c.purpose) + ". See\n.BR " +
           roff(program.name + "-" + c.name) + " (1).\n";
  out += options_of(program, ".SH");
  out += kExitStatus;
  out += ".SH ENVIRONMENT\n";
  for (const Variable& v : kVariables)
    out += ".TP\n.B " + std::string(v.name) + "\n" + roff(std::string(v.help)) + "\n";
  out +=
      ".SH EXAMPLES\n.TP\nWrite an interactive page of a shipped scenario:\n.B lrbscope run collision \\-o "
      "out\n.TP\nFind the intersecting faces of two meshes for each pose in a file:\n.B lrbscope query a.obj "
      "b.obj \\-\\-poses poses.txt \\-\\-pairs\n";
  return out;
}

/// Returns the manual page of one of its commands, with the options of its subcommands.
std::string command_page(const Command& program, const Command& command, const std::string& version) {
  const std::string name = program.name + "-" + command.name, call = program.name + " " + command.name;
  std::string out = heading(name, version);
  out += ".SH NAME\n" + roff(name) + " \\- " + roff(title_of(command.purpose)) + "\n";
  out += ".SH SYNOPSIS\n" + synopsis(call, command);
  out += ".SH DESCRIPTION\n" + roff(command.purpose) + ".\n";
  out += options_of(command, ".SH");
  for (const Command& below : command.commands) {
    out += ".SH \"" + upper(call.substr(program.name.size() + 1) + " " + below.name) + "\"\n" +
           roff(below.purpose) + ".\n.PP\n" + synopsis(call + " " + below.name, below);
    out += options_of(below, ".SS");
  }
  out += kExitStatus;
  return out + ".SH \"SEE ALSO\"\n.BR " + roff(program.name) + " (1)\n";
}

}  // namespace
}  // namespace lrb::completion

namespace lrb::cli {

namespace {

struct CompletionOptions {
  std::string shell, file;
};

int print_completion(const CLI::App& root, const CompletionOptions& o) {
  const completion::Command all = completion::command_of(root);
  const completion::ShippedNames names = {spec::shipped_names(spec::kScenarioEnding),
                                          spec::shipped_names(spec::kCrowdEnding),
                                          spec::shipped_names(spec::kExperimentEnding)};
  const std::string script = o.shell == "bash"  ? completion::bash_completion(all, names)
                             : o.shell == "zsh" ? completion::zsh_completion(all, names)
                                                : completion::fish_completion(all, names);
  if (!o.file.empty()) io::write_text(o.file, script);
  print(o.file.empty() ? script : o.file + "\n");
  return kOk;
}

struct ManualOptions {
  std::string command, folder;
};

int print_manual(const CLI::App& root, const ManualOptions& o) {
  const completion::Command all = completion::command_of(root);
  const std::string version = trace::lrbscope_version();
  bool known = o.command.empty();
  std::string page = known ? completion::program_page(all, version) : std::string();
  if (!o.folder.empty()) io::write_text(o.folder + "/lrbscope.1", completion::program_page(all, version));
  for (const completion::Command& c : all.commands) {
    const std::string text = completion::command_page(all, c, version);
    if (c.name == o.command) page = text;
    known |= c.name == o.command;
    if (!o.folder.empty()) io::write_text(o.folder + "/lrbscope-" + c.name + ".1", text);
  }
  if (!known)
    throw InputError("manual: unknown command " + printable_name(o.command) + "; see lrbscope --help");
  print(o.folder.empty() ? page : o.folder + "\n");
  return kOk;
}

}  // namespace

Command add_completion(App& root, const Globals&) {
  App* app = root.add_subcommand("completion", "Print a shell completion script");
  const auto o = std::make_shared<CompletionOptions>();
  app->add_option("SHELL", o->shell, "bash|zsh|fish", "Shell: bash, zsh or fish")
      ->required()
      ->one_of({"bash", "zsh", "fish"});
  app->add_option("-o,--output", o->file, "FILE", "File to write [stdout]");
  return {app, [&root, o] { return print_completion(root.definition(), *o); }};
}

Command add_manual(App& root, const Globals&) {
  App* app = root.add_subcommand("manual", "Print a manual page (read it with: lrbscope manual | man -l -)");
  const auto o = std::make_shared<ManualOptions>();
  auto* command =
      app->add_option("COMMAND", o->command, "COMMAND", "Command to print the page of [the program]");
  app->add_option("-o,--output", o->folder, "DIR", "Write all pages to this folder")->excludes(command);
  return {app, [&root, o] { return print_manual(root.definition(), *o); }};
}

}  // namespace lrb::cli
