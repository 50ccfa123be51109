/// What is made of the program's own words: completions of shells, and manual pages.
#include "scenarios/cli/words/completion.hpp"

#include <memory>
#include <string>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/words/manual.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/spec/shipped.hpp"
#include "trace/trace.hpp"

namespace lrb::cli {
namespace {

struct CompletionOptions {
  std::string shell, file;
};

int print_completion(const CLI::App& root, const CompletionOptions& o) {
  const words::Command all = words::words_of(root);
  const words::ShippedNames names = {spec::shipped_names(spec::kScenarioEnding),
                                     spec::shipped_names(spec::kCrowdEnding),
                                     spec::shipped_names(spec::kExperimentEnding)};
  const std::string script = o.shell == "bash"  ? words::bash_completion(all, names)
                             : o.shell == "zsh" ? words::zsh_completion(all, names)
                                                : words::fish_completion(all, names);
  if (!o.file.empty()) io::write_text(o.file, script);
  print(o.file.empty() ? script : o.file + "\n");
  return kOk;
}

struct ManualOptions {
  std::string command, folder;
};

int print_manual(const CLI::App& root, const ManualOptions& o) {
  const words::Command all = words::words_of(root);
  const std::string version = trace::lrbscope_version();
  bool known = o.command.empty();
  std::string page = known ? words::program_page(all, version) : std::string();
  if (!o.folder.empty()) io::write_text(o.folder + "/lrbscope.1", words::program_page(all, version));
  for (const words::Command& c : all.commands) {
    const std::string text = words::command_page(all, c, version);
    if (c.name == o.command) page = text;
    known |= c.name == o.command;
    if (!o.folder.empty()) io::write_text(o.folder + "/lrbscope-" + c.name + ".1", text);
  }
  if (!known)
    throw InputError("manual: there is no command " + printable_name(o.command) + "; see lrbscope --help");
  print(o.folder.empty() ? page : o.folder + "\n");
  return kOk;
}

}  // namespace

Command add_completion(CLI::App& root, const Globals&) {
  CLI::App* app =
      root.add_subcommand("completion", "Print the script by which a shell completes lrbscope's words");
  const auto o = std::make_shared<CompletionOptions>();
  app->add_option("SHELL", o->shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}).description(""))
      ->type_name("bash|zsh|fish");
  app->add_option("-o,--output", o->file, "Write it to this file")->type_name("FILE");
  return {app, [&root, o] { return print_completion(root, *o); }};
}

Command add_manual(CLI::App& root, const Globals&) {
  CLI::App* app = root.add_subcommand("manual", "Print a manual page, for man -l -");
  const auto o = std::make_shared<ManualOptions>();
  auto* command =
      app->add_option("COMMAND", o->command, "Of this command [of the program]")->type_name("COMMAND");
  app->add_option("-o,--output", o->folder, "Write all pages to this folder")
      ->excludes(command)
      ->type_name("DIR");
  return {app, [&root, o] { return print_manual(root, *o); }};
}

}  // namespace lrb::cli
