/// Completion of command lines: the shells' scripts ask the program, which knows its options.

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include <lrbscope/core/file.hpp>

namespace lrb::tools {
namespace {

constexpr std::string_view kBash =
    R"sh(# Completion of lrbscope for bash, written by `lrbscope completion bash`.
_lrbscope() {
  local cur=${COMP_WORDS[COMP_CWORD]} IFS=$'\n' found
  [ "$cur" != = ] || cur=""
  mapfile -t found < <("${COMP_WORDS[0]}" __complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  COMPREPLY=("${found[@]:1}")
  COMPREPLY=("${COMPREPLY[@]%%$'\t'*}")
  [ "${found[0]-}" = words ] || compopt -o filenames 2>/dev/null
  case "${found[0]-}" in
    files) COMPREPLY+=($(compgen -f -- "$cur")) ;;
    folders) COMPREPLY+=($(compgen -d -- "$cur")) ;;
  esac
}
complete -F _lrbscope lrbscope
)sh";

constexpr std::string_view kZsh =
    R"sh(#compdef lrbscope
# Completion of lrbscope for zsh, written by `lrbscope completion zsh`.
_lrbscope() {
  local -a found=("${(@f)$("$words[1]" __complete "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  local kind=$found[1]
  found=("${(@)found[2,-1]//:/\\:}")
  found=("${(@)found/$'\t'/:}")
  (( $#found )) && _describe -V lrbscope found
  case $kind in
    files) _files ;;
    folders) _files -/ ;;
  esac
}
if [ "$funcstack[1]" = _lrbscope ]; then _lrbscope "$@"; else compdef _lrbscope lrbscope; fi
)sh";

constexpr std::string_view kFish =
    R"sh(# Completion of lrbscope for fish, written by `lrbscope completion fish`.
function __lrbscope_complete
  set -l words (commandline -opc)
  set -l current (commandline -ct)
  set -l found ($words[1] __complete $words[2..] "$current" 2>/dev/null)
  switch "$found[1]"
    case files
      __fish_complete_path "$current"
    case folders
      __fish_complete_directories "$current"
  end
  printf '%s\n' $found[2..]
end
complete -c lrbscope -f -a '(__lrbscope_complete)'
)sh";

/// Completions of a word: whether files or folders are among them, and words with their help.
struct Completions {
  std::string kind = "words";
  std::vector<std::pair<std::string, std::string>> words = {};

  void add_all(const std::vector<std::string>& more) {
    for (const std::string& word : more) words.emplace_back(word, "");
  }
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

/// Adds the values of an option or argument, from the names of values that commands use.
void add_values(const CLI::Option& option, Completions& out) {
  const std::string type = option.get_type_name(), name = option.get_name(true, false);
  const std::string word = type.substr(0, type.find_first_of(":= "));
  const auto file_or = [&](std::string_view ending) {
    out.kind = "files";
    if (!ending.empty()) out.add_all(spec::shipped_names(ending));
  };
  if (const auto choices = choices_of(word); !choices.empty()) return out.add_all(choices);
  if (name == "SCENARIO" || name == "SOURCE" || name == "INPUT") return file_or(spec::kScenarioEnding);
  if (name == "CROWD") return file_or(spec::kCrowdEnding);
  if (word == "NAME|FILE") return file_or(spec::kExperimentEnding);
  const auto has = [&](const char* part) { return word.find(part) != std::string::npos; };
  if (word == "DIR" || word == "FOLDER")
    out.kind = "folders";
  else if (has("FILE") || has(".") || has("PATH") || word == "PNG" || word == "TEXT")
    file_or("");
}

bool is_shown(const CLI::Option* option) {
  return !option->get_group().empty();
}

/// Adds the names of options: the command's own ones, then those of the program.
void add_options(const CLI::App& root, const CLI::App& app, Completions& out) {
  for (const CLI::App* of : {&app, &root}) {
    for (const CLI::Option* option : of->get_options(is_shown))
      for (const auto& [names, dashes] : {std::pair(option->get_snames(), "-"), {option->get_lnames(), "--"}})
        for (const std::string& name : names)
          out.words.emplace_back(dashes + name, option->get_description());
    if (of == &root) break;
  }
}

/// Returns the completions of the last word, in the order of --help.
Completions completions_of(const CLI::App& root, const std::vector<std::string>& words) {
  const CLI::App* app = &root;
  const CLI::Option* awaits_value = nullptr;
  Completions out;
  std::string current = words.empty() ? "" : words.back();
  const auto option_named = [&](const std::string& name) -> const CLI::Option* {
    const CLI::Option* found = app->get_option_no_throw(name);
    if (found == nullptr) found = root.get_option_no_throw(name);
    return found != nullptr && found->get_items_expected_max() > 0 ? found : nullptr;
  };
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i] == "=") continue;  // bash passes "--mode=any" as three words
    awaits_value = words[i].starts_with('-') ? option_named(words[i]) : nullptr;
    const auto below = app->get_subcommands([&](const CLI::App* a) { return a->get_name() == words[i]; });
    if (!below.empty()) app = below.front();
  }
  std::string before;  // of the word, kept in each completion
  if (current == "=") current.clear();
  if (const std::size_t equals = current.find('=');
      current.starts_with("--") && equals != std::string::npos) {
    awaits_value = option_named(current.substr(0, equals));
    before = current.substr(0, equals + 1);
  }
  if (awaits_value != nullptr) {
    add_values(*awaits_value, out);
    if (const std::size_t comma = current.rfind(','); out.kind == "words" && comma != std::string::npos)
      before = current.substr(0, comma + 1);
  } else if (current.starts_with('-')) {
    add_options(root, *app, out);
  } else if (const auto commands = app->get_subcommands({}); !commands.empty()) {
    for (const CLI::App* command : commands)
      out.words.emplace_back(command->get_name(), command->get_description());
  } else {
    const auto arguments =
        app->get_options([](const CLI::Option* o) { return is_shown(o) && o->get_positional(); });
    if (!arguments.empty()) add_values(*arguments.front(), out);
  }
  for (auto& [word, help] : out.words) word.insert(0, before);
  std::erase_if(out.words, [&](const auto& word) { return !word.first.starts_with(current); });
  return out;
}

}  // namespace

int print_completions(const App& root, const std::vector<std::string>& words) {
  const Completions found = completions_of(root.definition(), words);
  std::string out = found.kind + "\n";
  for (const auto& [word, help] : found.words) out += word + (help.empty() ? "" : "\t" + help) + "\n";
  print(out);
  return kOk;
}

Command add_completion(App& root, const Globals&) {
  App* app = root.add_subcommand("completion", "Print a shell completion script");
  struct CompletionOptions {
    std::string shell, file;
  };
  const auto o = std::make_shared<CompletionOptions>();
  app->add_option("SHELL", o->shell, "bash|zsh|fish", "Shell: bash, zsh or fish")
      ->required()
      ->one_of({"bash", "zsh", "fish"});
  app->add_option("-o,--output", o->file, "FILE", "File to write [stdout]");
  return {app, [o] {
            const std::string script(o->shell == "bash" ? kBash : o->shell == "zsh" ? kZsh : kFish);
            if (!o->file.empty()) io::write_text(o->file, script);
            print(o->file.empty() ? script : o->file + "\n");
            return kOk;
          }};
}

}  // namespace lrb::tools
