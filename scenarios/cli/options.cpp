#include "scenarios/cli/options.hpp"

#include <map>

namespace lrb::cli {

void add_request_options(CLI::App& app, CollideRequest& request) {
  static const std::map<std::string, Mode> modes = {{"all", Mode::all_pairs}, {"first", Mode::first_pair}};
  static const std::map<std::string, Recursion> recursions = {
      {"complete", Recursion::complete}, {"paper", Recursion::paper}, {"paper_strict", Recursion::paper_strict}};
  app.add_option("--mode", request.mode, "all pairs, or the first found")
      ->transform(CLI::CheckedTransformer(modes).description(""))
      ->type_name("all|first");
  app.add_option("--recursion", request.recursion, "complete never misses; paper is the paper's own")
      ->transform(CLI::CheckedTransformer(recursions).description(""))
      ->type_name("complete|paper|paper_strict");
}

void add_build_options(CLI::App& app, BuildOptions& options) {
  app.add_option("--patch", options.patch_interior, "Interior vertices a patch aims at")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--max-outer", options.max_outer_faces, "Faces the outermost wrapper should have at most")
      ->check(CLI::Range(4, 1000))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--seed", options.seed, "Of the order in which patches grow")->capture_default_str()->type_name("N");
}

}  // namespace lrb::cli
