/// The list of all commands.
#include "tools/commands.hpp"

namespace lrb::tools {

std::vector<Command> add_commands(App& root, const Globals& globals) {
  std::vector<Command> commands;
// A command's file defines add_NAME(), which adds the command and returns the function that runs it.
#define LRB_COMMAND(NAME)                       \
  Command add_##NAME(App& app, const Globals&); \
  commands.push_back(add_##NAME(root, globals))
  LRB_COMMAND(run);
  LRB_COMMAND(collide);
  LRB_COMMAND(crowd);
  LRB_COMMAND(query);
  LRB_COMMAND(distance);
  LRB_COMMAND(near);
  LRB_COMMAND(points);
  LRB_COMMAND(why);
  LRB_COMMAND(clash);
  LRB_COMMAND(manifold);
  LRB_COMMAND(sweep);
  LRB_COMMAND(build);
  LRB_COMMAND(inspect);
  LRB_COMMAND(close);
  LRB_COMMAND(import);
  LRB_COMMAND(tree);
  LRB_COMMAND(check);
  LRB_COMMAND(live);
  LRB_COMMAND(compare);
  LRB_COMMAND(render);
  LRB_COMMAND(export);
  LRB_COMMAND(figure);
  LRB_COMMAND(paper);
  LRB_COMMAND(golden);
#ifdef LRB_BUILD_BENCH
  LRB_COMMAND(stability);
#endif
  LRB_COMMAND(doctor);
  LRB_COMMAND(list);
#ifdef LRB_BUILD_BENCH
  LRB_COMMAND(bench);
  LRB_COMMAND(chart);
#endif
  LRB_COMMAND(completion);
#undef LRB_COMMAND
  return commands;
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string out = "lrbscope";
  for (const std::string& word : words) out += " " + shell_word(word);
  return out;
}

}  // namespace lrb::tools
