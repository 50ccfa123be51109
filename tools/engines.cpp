#include "tools/engines.hpp"

#include <algorithm>
#include <cctype>

#include "scenarios/bodies/shapes.hpp"
#include "tools/options.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::cli {

void add_engine_options(App& app, EngineOptions& o) {
  app.add_option("--method", o.methods, "NAME,...",
                 "Engines, separated by commas: ours, or others that were installed when lrbscope was built; "
                 "see `lrbscope doctor` [ours]")
      ->delimiter(',');
  app.add_option(
      "--command", o.command, "PROGRAM",
      "Program of another engine: started as PROGRAM A B POSES, it answers a query for each line of "
      "POSES and records them with lrbscope_capture.h");
  app.add_option("--timeout", o.timeout, "S",
                 "Time limit in seconds, per pose of a method, and per start of a --command [60]")
      ->in_range(0.1, 36000.0);
  add_join_option(app, o.corners);
}

Contest make_contest(const EngineOptions& o) {
  std::vector<std::string> names = o.methods;
  if (names.empty() && o.command.empty()) names = {"ours"};
  const bool others =
      std::any_of(names.begin(), names.end(), [](const std::string& n) { return n != "ours"; });
  const std::vector<workers::WorkerMethod> known =
      others ? workers::find_all_methods() : std::vector<workers::WorkerMethod>{};
  auto bodies =
      std::make_unique<std::array<bodies::LoadedBody, 2>>(bodies::load_faces_of_two(o.a, o.b, o.corners));
  for (std::size_t i = 0; i < 2; ++i)
    if ((*bodies)[i].rep.dim() != 3)
      throw InputError(printable_name(i == 0 ? o.a : o.b) + ": expected a 3D body, found a 2D body");
  const LrbRep &a = (*bodies)[0].rep, &b = (*bodies)[1].rep;
  std::vector<std::unique_ptr<tails::Engine>> engines;
  for (const std::string& name : names) {
    if (name == "ours") {
      engines.push_back(tails::our_engine(a, b));
      continue;
    }
    const workers::WorkerMethod method = chosen_methods(known, {name}).front();
    if (!method.info.pairs)
      throw InputError("method '" + name + "': expected one that lists all pairs, found one that does not");
    engines.push_back(tails::worker_engine(method, o.files(), o.limit()));
  }
  if (!o.command.empty()) engines.push_back(tails::command_engine(o.command, o.files(), o.limit()));
  return {std::move(bodies), tails::PoseSpace(shapes::box_of(a), shapes::box_of(b)), std::move(engines)};
}

std::vector<std::string> record_words(const EngineOptions& o, const std::string& engine,
                                      const std::string& pose_file, const std::string& folder) {
  if (!o.command.empty() && engine == o.command) return {"import", folder + ".lrbcap", "-o", folder};
  std::vector<std::string> words = {"collide", o.a, o.b};
  if (engine == "fcl" || engine == "cgal") words = {"xray", o.a, o.b, "--method", engine};
  words.insert(words.end(), {"--poses", pose_file, "-o", folder});
  if (o.corners == bodies::Corners::apart) words.emplace_back("--no-join");
  return words;
}

std::string record_line(const EngineOptions& o, const std::string& engine, const std::string& pose_file,
                        const std::string& folder) {
  const std::string line = shell_line(record_words(o, engine, pose_file, folder));
  if (o.command.empty() || engine != o.command) return line;
  return "LRBCAP_OUT=" + shell_word(folder + ".lrbcap") + " " + o.command + " " + shell_word(o.a) + " " +
         shell_word(o.b) + " " + shell_word(pose_file) + " && " + line;
}

std::string file_word(const std::string& name) {
  std::string out;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      out += c;
    else if (!out.empty() && out.back() != '-')
      out += '-';
  return out.empty() ? "engine" : out;
}

}  // namespace lrb::cli
