#include "scenarios/cli/words/manual.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace lrb::words {
namespace {

/// Returns text as roff shows it: a hyphen can be copied, and no line is a request.
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

/// Returns "NAME..." in square brackets unless it has to be given.
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

/// Returns a sentence without its full stop, as headings of manual pages are.
std::string title_of(std::string purpose) {
  while (!purpose.empty() && purpose.back() == '.') purpose.pop_back();
  if (!purpose.empty()) purpose[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(purpose[0])));
  return purpose;
}

constexpr std::string_view kExitStatus =
    ".SH \"EXIT STATUS\"\n"
    ".TP\n0\nDone.\n"
    ".TP\n1\nA mismatch: an expectation, a golden run or a proof failed.\n"
    ".TP\n2\nBad usage or input; one line on stderr names the place.\n"
    ".TP\n3\nThe machine lacks something: memory, space, a package.\n";

struct Variable {
  std::string_view name, help;
};
constexpr std::array kVariables = {
    Variable{"LRB_FONT", "The font file for texts in pictures, where DejaVu Sans is not installed."},
    Variable{"LRB_SIMD",
             "avx2 or baseline: the kernels of older processors than the one at hand. Answers are the same."},
    Variable{"LRBSCOPE_METHODS", "The folder with the worker programs of other engines."},
    Variable{"NO_COLOR", "If set, progress is drawn without colours."}};

}  // namespace

std::string program_page(const Command& program, const std::string& version) {
  std::string out = heading(program.name, version);
  out += ".SH NAME\n" + roff(program.name) + " \\- " + roff(title_of(program.purpose)) + "\n";
  out += ".SH SYNOPSIS\n" + synopsis(program.name, program);
  out +=
      ".SH DESCRIPTION\n"
      "Finds which faces of two bodies meet, exactly, for bodies of any shape, and shows how it found out:\n"
      "every comparison and every refinement can be recorded, replayed and drawn. What is printed is data; what\n"
      "is said to people goes to stderr.\n";
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
      ".SH EXAMPLES\n.TP\nA page on which a shipped scenario can be watched:\n"
      ".B lrbscope run collision \\-o out\n"
      ".TP\nWhich faces of two meshes meet, for each pose of a list:\n"
      ".B lrbscope query a.obj b.obj \\-\\-poses poses.txt \\-\\-pairs\n";
  return out;
}

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

}  // namespace lrb::words
