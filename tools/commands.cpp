/// The list of all commands.
#include "tools/commands.hpp"

#include <algorithm>
#include <array>

namespace lrb::cli {

// Each adds a command with its options to the program, and returns the function that runs it.
Command add_run(CLI::App& root, const Globals& globals);
Command add_collide(CLI::App& root, const Globals& globals);
Command add_crowd(CLI::App& root, const Globals& globals);
Command add_query(CLI::App& root, const Globals& globals);
Command add_distance(CLI::App& root, const Globals& globals);
Command add_near(CLI::App& root, const Globals& globals);
Command add_points(CLI::App& root, const Globals& globals);
Command add_why(CLI::App& root, const Globals& globals);
Command add_clash(CLI::App& root, const Globals& globals);
Command add_manifold(CLI::App& root, const Globals& globals);
Command add_sweep(CLI::App& root, const Globals& globals);
Command add_build(CLI::App& root, const Globals& globals);
Command add_inspect(CLI::App& root, const Globals& globals);
Command add_close(CLI::App& root, const Globals& globals);
Command add_levels(CLI::App& root, const Globals& globals);
Command add_xray(CLI::App& root, const Globals& globals);
Command add_import(CLI::App& root, const Globals& globals);
Command add_tree(CLI::App& root, const Globals& globals);
Command add_check(CLI::App& root, const Globals& globals);
Command add_live(CLI::App& root, const Globals& globals);
Command add_compare(CLI::App& root, const Globals& globals);
Command add_render(CLI::App& root, const Globals& globals);
Command add_export(CLI::App& root, const Globals& globals);
Command add_figure(CLI::App& root, const Globals& globals);
Command add_paper(CLI::App& root, const Globals& globals);
Command add_golden(CLI::App& root, const Globals& globals);
Command add_stability(CLI::App& root, const Globals& globals);
Command add_doctor(CLI::App& root, const Globals& globals);
Command add_list(CLI::App& root, const Globals& globals);
Command add_bench(CLI::App& root, const Globals& globals);
Command add_chart(CLI::App& root, const Globals& globals);
Command add_tails(CLI::App& root, const Globals& globals);
Command add_worst(CLI::App& root, const Globals& globals);
Command add_completion(CLI::App& root, const Globals& globals);
Command add_manual(CLI::App& root, const Globals& globals);

namespace {

/// The commands in the order of --help.
constexpr auto kCommands = std::to_array<Command (*)(CLI::App&, const Globals&)>({
    add_run,    add_collide, add_crowd,    add_query, add_distance, add_near,       add_points,
    add_why,    add_clash,   add_manifold, add_sweep, add_build,    add_inspect,    add_close,
    add_levels, add_xray,    add_import,   add_tree,  add_check,    add_live,       add_compare,
    add_render, add_export,  add_figure,   add_paper, add_golden,   add_stability,  add_doctor,
    add_list,   add_bench,   add_chart,    add_tails, add_worst,    add_completion, add_manual,
});

}  // namespace

std::vector<Command> add_commands(CLI::App& root, const Globals& globals) {
  std::vector<Command> commands;
  for (const auto add : kCommands) commands.push_back(add(root, globals));
  return commands;
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string out = "lrbscope";
  for (const std::string& word : words) out += " " + shell_word(word);
  return out;
}

int run_command(const std::vector<std::string>& words, const Globals& globals) {
  Globals own = globals;
  own.command_line = shell_line(words);
  CLI::App app("", "lrbscope");
  const std::vector<Command> commands = add_commands(app, own);
  app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them from the back
  const auto named =
      std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.app->parsed(); });
  return named->run();
}

}  // namespace lrb::cli
