/// The list of all commands.
#include "tools/commands.hpp"

#include <array>

namespace lrb::tools {

// Each adds a command with its options to the program, and returns the function that runs it.
Command add_run(App& root, const Globals& globals);
Command add_collide(App& root, const Globals& globals);
Command add_crowd(App& root, const Globals& globals);
Command add_query(App& root, const Globals& globals);
Command add_distance(App& root, const Globals& globals);
Command add_near(App& root, const Globals& globals);
Command add_points(App& root, const Globals& globals);
Command add_why(App& root, const Globals& globals);
Command add_clash(App& root, const Globals& globals);
Command add_manifold(App& root, const Globals& globals);
Command add_sweep(App& root, const Globals& globals);
Command add_build(App& root, const Globals& globals);
Command add_inspect(App& root, const Globals& globals);
Command add_close(App& root, const Globals& globals);
Command add_import(App& root, const Globals& globals);
Command add_tree(App& root, const Globals& globals);
Command add_check(App& root, const Globals& globals);
Command add_live(App& root, const Globals& globals);
Command add_compare(App& root, const Globals& globals);
Command add_render(App& root, const Globals& globals);
Command add_export(App& root, const Globals& globals);
Command add_figure(App& root, const Globals& globals);
Command add_paper(App& root, const Globals& globals);
Command add_golden(App& root, const Globals& globals);
Command add_stability(App& root, const Globals& globals);
Command add_doctor(App& root, const Globals& globals);
Command add_list(App& root, const Globals& globals);
Command add_bench(App& root, const Globals& globals);
Command add_chart(App& root, const Globals& globals);
Command add_completion(App& root, const Globals& globals);

namespace {

/// The commands in the order of --help.
constexpr auto kCommands = std::to_array<Command (*)(App&, const Globals&)>({
    add_run,        add_collide,  add_crowd,   add_query,  add_distance, add_near,   add_points, add_why,
    add_clash,      add_manifold, add_sweep,   add_build,  add_inspect,  add_close,  add_import, add_tree,
    add_check,      add_live,     add_compare, add_render, add_export,   add_figure, add_paper,  add_golden,
#ifdef LRB_BUILD_BENCH
    add_stability,
#endif
    add_doctor,     add_list,
#ifdef LRB_BUILD_BENCH
    add_bench,      add_chart,
#endif
    add_completion,
});

}  // namespace

std::vector<Command> add_commands(App& root, const Globals& globals) {
  std::vector<Command> commands;
  for (const auto add : kCommands) commands.push_back(add(root, globals));
  return commands;
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string out = "lrbscope";
  for (const std::string& word : words) out += " " + shell_word(word);
  return out;
}

}  // namespace lrb::tools
