#include "scenarios/cli/words/words.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace lrb::words {
namespace {

/// Returns the words of a type such as "png|svg" or "answers,events"; none for another type.
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

/// Returns what completes a value, by the names that commands give to values.
Value value_of(const std::string& type, const std::string& name, bool positional) {
  const std::string word = type.substr(0, type.find_first_of(":= "));
  if (!choices_of(word).empty()) return Value::choice;
  if (positional && (name == "SCENARIO" || name == "SOURCE" || name == "INPUT")) return Value::scenario;
  if (positional && name == "CROWD") return Value::crowd;
  if (word == "NAME|FILE") return Value::experiment;
  if (word == "DIR" || word == "FOLDER") return Value::folder;
  const bool names_file = word.find("FILE") != std::string::npos || word.find('.') != std::string::npos ||
                          word == "PNG" || word.find("PATH") != std::string::npos;
  // A text that says no more is a file in this program.
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

}  // namespace

Command words_of(const CLI::App& app) {
  Command out;
  out.name = app.get_name();
  out.purpose = app.get_description();
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); }))
    out.options.push_back(option_of(*option));
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
    out.commands.push_back(words_of(*command));
  return out;
}

}  // namespace lrb::words
