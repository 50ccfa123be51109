#pragma once
/// The command line as the commands define it. Only command_line.cpp includes CLI11, whose templates take
/// seconds in every file.

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lrb::tools {

/// An option, a flag or an argument. The setters return the option itself.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option* type_name(const std::string& name);  ///< of its value, in the help
  Option* description(const std::string& help);
  /// Limits each value. The help shows the range. T: int, unsigned, std::uint64_t or double.
  template <class T>
  Option* in_range(T least, T most);
  template <class T>
  Option* in_hidden_range(T least, T most);
  Option* not_negative();
  Option* positive();
  Option* one_of(const std::vector<std::string>& words);
  /// `fault` returns what is wrong with a value, or an empty text.
  Option* satisfies(const std::function<std::string(const std::string&)>& fault);
  Option* required();
  Option* excludes(const Option* other);
  Option* needs(const Option* other);
  Option* delimiter(char c);  ///< separates several values in a word
  Option* expected(int count) { return expected(count, count); }
  Option* expected(int least, int most);  ///< the number of values
  Option* allow_extra_args(bool allowed);
  Option* capture_default_str();  ///< the help shows the target's present value

  std::string name() const;  ///< "--output", or of an argument "FILE"
  bool is_argument() const;
  bool given() const;

 private:
  CLI::Option* option_;
};

/// A program or one of its commands.
class App {
 public:
  App(const std::string& description, const std::string& name);
  explicit App(CLI::App* command);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  /// T: a number, a text, a list of these, or std::optional of one; command_line.cpp lists the types. `type`:
  /// name of the value in the help.
  template <class T>
  Option* add_option(const std::string& names, T& target, const std::string& help);
  template <class T>
  Option* add_option(const std::string& names, T& target, const std::string& type, const std::string& help) {
    return add_option(names, target, help)->type_name(type);
  }
  /// T: std::string, or a list of them for options that can be repeated.
  template <class T>
  Option* add_option_function(const std::string& names, const std::function<void(const T&)>& take,
                              const std::string& type, const std::string& help);
  /// T: bool, or std::optional of it.
  template <class T>
  Option* add_flag(const std::string& names, T& target, const std::string& help);
  Option* add_flag_callback(const std::string& names, const std::function<void()>& take,
                            const std::string& help);
  Option* get_option(const std::string& name);  ///< an option that was added
  const std::deque<Option>& options() const { return options_; }

  App* add_subcommand(const std::string& name, const std::string& description);
  App* require_subcommand(int least = 1, int most = 1);
  App* fallthrough();  ///< options of the program may follow the command
  void set_version(const std::string& text);
  void footer(const std::string& text);
  bool parsed() const;  ///< the command was given
  /// Calls visit(option, value) for each value of options and arguments that was given.
  void for_each_value(
      const std::function<void(const std::string& option, const std::string& value)>& visit) const;

  /// Parses words. Returns the text that --help or --version requests, or nullopt. Throws InputError for a
  /// usage error.
  std::optional<std::string> parse(const std::vector<std::string>& words);
  const CLI::App& definition() const { return *app_; }

 private:
  Option* added(CLI::Option* option);

  std::unique_ptr<CLI::App> own_;  ///< of the program
  CLI::App* app_;
  std::deque<Option> options_;
  std::deque<App> commands_;
};

/// Throws an error about an option's value that is reported as a usage error.
[[noreturn]] void reject_value(const std::string& option, const std::string& why);

}  // namespace lrb::tools
