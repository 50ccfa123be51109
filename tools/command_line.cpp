#include "tools/command_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string_view>

#include <CLI/CLI.hpp>

#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tools {

#define LRB_SETTER(declaration, call) \
  Option* Option::declaration {       \
    option_->call;                    \
    return this;                      \
  }
LRB_SETTER(type_name(const std::string& name), type_name(name))
LRB_SETTER(description(const std::string& help), description(help))
template <class T>
LRB_SETTER(in_range(T least, T most), check(CLI::Range(least, most)))
template <class T>
LRB_SETTER(in_hidden_range(T least, T most), check(CLI::Range(least, most).description("")))
LRB_SETTER(not_negative(), check(CLI::NonNegativeNumber)) LRB_SETTER(positive(), check(CLI::PositiveNumber))
    LRB_SETTER(one_of(const std::vector<std::string>& words), check(CLI::IsMember(words).description("")))
        LRB_SETTER(satisfies(const std::function<std::string(const std::string&)>& fault),
                   check(CLI::Validator([fault](std::string& value) { return fault(value); }, "")))
            LRB_SETTER(required(), required())
                LRB_SETTER(excludes(const Option* other), excludes(other->option_))
                    LRB_SETTER(needs(const Option* other), needs(other->option_))
                        LRB_SETTER(delimiter(char c), delimiter(c))
                            LRB_SETTER(expected(int least, int most), expected(least, most))
                                LRB_SETTER(allow_extra_args(bool allowed), allow_extra_args(allowed))
                                    LRB_SETTER(capture_default_str(), capture_default_str())
#undef LRB_SETTER

#define LRB_RANGE(T)                       \
  template Option* Option::in_range(T, T); \
  template Option* Option::in_hidden_range(T, T);
                                        LRB_RANGE(int) LRB_RANGE(unsigned) LRB_RANGE(std::uint64_t)
                                            LRB_RANGE(double)
#undef LRB_RANGE

                                                std::string Option::name() const {
  return option_->get_name();
}
bool Option::is_argument() const {
  return option_->get_positional();
}
bool Option::given() const {
  return option_->count() > 0;
}

App::App(const std::string& description, const std::string& name)
    : own_(std::make_unique<CLI::App>(description, name)), app_(own_.get()) {}
App::App(CLI::App* command) : app_(command) {}
App::~App() = default;

Option* App::added(CLI::Option* option) {
  return &options_.emplace_back(option);
}

template <class T>
Option* App::add_option(const std::string& names, T& target, const std::string& help) {
  return added(app_->add_option(names, target, help));
}
template <class T>
Option* App::add_option_function(const std::string& names, const std::function<void(const T&)>& take,
                                 const std::string& type, const std::string& help) {
  return added(app_->add_option_function<T>(names, take, help))->type_name(type);
}
template <class T>
Option* App::add_flag(const std::string& names, T& target, const std::string& help) {
  return added(app_->add_flag(names, target, help));
}
Option* App::add_flag_callback(const std::string& names, const std::function<void()>& take,
                               const std::string& help) {
  return added(app_->add_flag_callback(names, take, help));
}

// The types of targets.
#define LRB_OPTION(T) template Option* App::add_option(const std::string&, T&, const std::string&);
LRB_OPTION(int)
LRB_OPTION(std::uint16_t)
LRB_OPTION(std::uint32_t)
LRB_OPTION(std::uint64_t)
LRB_OPTION(double)
LRB_OPTION(std::string)
LRB_OPTION(std::vector<std::uint32_t>)
LRB_OPTION(std::vector<double>)
LRB_OPTION(std::vector<std::string>)
LRB_OPTION(std::optional<int>)
LRB_OPTION(std::optional<std::uint32_t>)
LRB_OPTION(std::optional<std::uint64_t>)
LRB_OPTION(std::optional<double>)
#undef LRB_OPTION
template Option* App::add_option_function(const std::string&, const std::function<void(const std::string&)>&,
                                          const std::string&, const std::string&);
template Option* App::add_option_function(const std::string&,
                                          const std::function<void(const std::vector<std::string>&)>&,
                                          const std::string&, const std::string&);
template Option* App::add_flag(const std::string&, bool&, const std::string&);
template Option* App::add_flag(const std::string&, std::optional<bool>&, const std::string&);

Option* App::get_option(const std::string& name) {
  const auto named = std::ranges::find_if(options_, [&](const Option& o) { return o.name() == name; });
  return &*named;
}

App* App::add_subcommand(const std::string& name, const std::string& description) {
  return &commands_.emplace_back(app_->add_subcommand(name, description));
}
App* App::require_subcommand(int least, int most) {
  app_->require_subcommand(static_cast<std::size_t>(least), static_cast<std::size_t>(most));
  return this;
}
App* App::fallthrough() {
  app_->fallthrough();
  return this;
}
void App::set_version(const std::string& text) {
  app_->set_version_flag("-V,--version", text);
}
void App::footer(const std::string& text) {
  app_->footer(text);
}
bool App::parsed() const {
  return app_->parsed();
}

void reject_value(const std::string& option, const std::string& why) {
  throw CLI::ValidationError(option, why);
}

// Parsing, and errors in the words of this program.

namespace {

/// Breaks a line of CLI11's help at spaces. Descriptions of options and commands are continued in their
/// column.
std::string wrapped(std::string line) {
  constexpr std::size_t kWidth = 100, kDescriptions = 30;  // kDescriptions: CLI11's default column
  const bool has_column = line.size() > kDescriptions && line[0] == ' ' && line[kDescriptions - 1] == ' ';
  const std::size_t indent = has_column ? kDescriptions : 0;
  std::string out;
  while (line.size() > kWidth) {
    const std::size_t space = line.rfind(' ', kWidth);
    if (space == std::string::npos || space <= indent) break;  // a word longer than the column
    out += line.substr(0, space) + "\n";
    line = std::string(indent, ' ') + line.substr(space + 1);
  }
  return out + line + "\n";
}

/// Returns CLI11's text for --help and --version, in lines of at most 100 columns.
std::string help_text(const CLI::App& app, const CLI::ParseError& request) {
  std::stringstream text;
  app.exit(request, text, text);
  std::string out;
  for (std::string line; std::getline(text, line);) {
    line.erase(line.find_last_not_of(' ') + 1);  // CLI11 2.6 ends lines with a blank
    out += wrapped(line);
  }
  return out;
}

/// Returns the first word that is not an option: the command's name.
std::string command_word(const std::vector<std::string>& words) {
  const auto word = std::ranges::find_if(words, [](const std::string& w) { return !w.starts_with('-'); });
  return word == words.end() ? "" : *word;
}

/// Returns the selected command, down to subcommands: for `lrbscope golden test` it is test.
const CLI::App& named_command(const CLI::App& app) {
  const std::vector<CLI::App*> below = app.get_subcommands();
  return below.empty() ? app : named_command(*below.front());
}

/// Returns "lrbscope golden test".
std::string call_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : call_of(*app.get_parent()) + " " + app.get_name();
}

/// Returns "; did you mean \"x\"?" if a known word is close to this one, or an empty text.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = io::nearest_word(word, known);
  return near.empty() ? "" : "; did you mean \"" + near + "\"?";
}

/// Returns a message of CLI11 in the words of this program's own ones. `app`: the command.
std::string plain_message(const CLI::App& root, const CLI::App& app, const CLI::ParseError& error) {
  const std::string text = error.what();
  // "NAME: Value X not in range 0 to 1"; CLI11 2.6: "[0 - 1]".
  constexpr std::string_view kValue = ": Value ", kRange = " not in range ", kUnread = "Could not convert: ";
  const std::size_t value = text.find(kValue), range = text.rfind(kRange);
  if (value < range && range != std::string::npos) {
    std::string limits = text.substr(range + kRange.size());
    std::erase_if(limits, [](char c) { return c == '[' || c == ']'; });
    std::istringstream in(limits);
    double low = 0, high = 0;
    std::string to;
    in >> low >> to >> high;
    const auto number = [](double x) { return io::number_text(x, 6); };
    const std::size_t from = value + kValue.size();
    const std::string found = text.substr(from, range - from);
    const bool is_bounded = high < std::numeric_limits<float>::max();
    const double x = std::strtod(found.c_str(), nullptr);
    constexpr std::size_t kLong = 40;
    // Ranges of positive numbers begin at the least normal double, which CLI11 prints as 0.
    return text.substr(0, value) + ": expected " +
           (is_bounded          ? number(low) + " to " + number(high)
            : !std::isfinite(x) ? "a finite number of at least " + number(low)
            : std::fpclassify(x) == FP_SUBNORMAL && x > 0 && low == 0 ? "a number that is not subnormal"
            : x == low                                                ? "a number above " + number(low)
                                                                      : "at least " + number(low)) +
           ", found " + (found.size() > kLong ? in_quotes(found) : found);
  }
  if (const std::size_t equals = text.find(" = "); text.starts_with(kUnread) && equals != std::string::npos)
    return text.substr(kUnread.size(), equals - kUnread.size()) + ": cannot read " +
           in_quotes(text.substr(equals + 3));
  if (!text.starts_with("The following argument")) return text;
  const std::vector<std::string> words = root.remaining(true);
  const auto option = std::ranges::find_if(words, [](const std::string& w) { return w.starts_with("--"); });
  if (option == words.end()) return text;
  std::vector<std::string> known;
  for (const CLI::Option* o : app.get_options())
    for (const std::string& name : o->get_lnames()) known.push_back("--" + name);
  return in_quotes(*option) + " is not an option of " + call_of(app) + did_you_mean(*option, known);
}

/// Commands of earlier versions, with their replacements.
constexpr std::pair<std::string_view, std::string_view> kRemovedCommands[] = {
    {"levels", "use `lrbscope inspect FILE --levels`"},
    {"tails", "use `lrbscope bench --percentiles A B`"},
    {"worst", "use `lrbscope stability --search A B`"},
    {"xray", "record the engine and use `lrbscope import`; see docs/profiling.md"},
};

/// Returns the error message for a command line that CLI11 rejected. `word`: the first word that is not an
/// option.
std::string usage_error(const CLI::App& root, const CLI::ParseError& error, std::string word) {
  const CLI::App* app = &root;
  const auto is_named = [&](const CLI::App* a) { return a->get_name() == word; };
  if (word.empty() || !root.get_subcommands(is_named).empty()) {
    app = &named_command(root);
    const std::vector<std::string> words = root.remaining(true);
    const auto other =
        std::ranges::find_if(words, [](const std::string& w) { return !w.empty() && w[0] != '-'; });
    word = other == words.end() ? "" : *other;
  }
  const std::string help = " (see " + call_of(*app) + " --help)";
  std::vector<std::string> known;
  for (const CLI::App* c : app->get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
    known.push_back(c->get_name());
  if (known.empty() || word.empty()) return plain_message(root, *app, error) + help;
  for (const auto& [name, instead] : kRemovedCommands)
    if (app == &root && word == name) return in_quotes(word) + " was removed in 2.0; " + std::string(instead);
  return in_quotes(word) + " is not a command of " + call_of(*app) + did_you_mean(word, known) + help;
}

template <class Visit>
void visit_values(const CLI::App& app, const Visit& visit) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results()) visit(option->get_name(), value);
  for (const CLI::App* below : app.get_subcommands()) visit_values(*below, visit);
}

}  // namespace

void App::for_each_value(
    const std::function<void(const std::string& option, const std::string& value)>& visit) const {
  visit_values(*app_, visit);
}

std::optional<std::string> App::parse(const std::vector<std::string>& words) {
  try {
    app_->parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them from the back
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return help_text(*app_, e);
    throw InputError(usage_error(*app_, e, command_word(words)));
  }
  for_each_value([](const std::string& option, const std::string& value) {
    if (value.empty())
      throw InputError(option + ": expected a value, found an empty string; is a shell variable unset?");
  });
  return std::nullopt;
}

}  // namespace lrb::tools
