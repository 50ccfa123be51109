#include "tools/bench_options.hpp"

#include <algorithm>
#include <filesystem>

#include "scenarios/bodies/shapes.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tools {

std::vector<workers::WorkerMethod> chosen_methods(const std::vector<workers::WorkerMethod>& all,
                                                  const std::vector<std::string>& names) {
  std::vector<workers::WorkerMethod> out =
      chosen(all, names, "method", [](const workers::WorkerMethod& m) { return m.info.name; });
  if (!names.empty())
    for (const workers::WorkerMethod& m : out)
      if (!m.info.present) throw EnvironmentError("method '" + m.info.name + "': " + m.info.remark);
  return out;
}

void add_measure_options(App& app, MeasureOptions& o) {
  app.add_option("-o,--output", o.folder, "DIR",
                 "Output folder; a survey found in it is continued [" + o.folder_help + "]");
  app.add_option("--models", o.models, "DIR", "Folder of additional meshes; each is collided with the next");
  app.add_option("--method", o.methods, "NAME", "Only these methods")->delimiter(',');
  app.add_option("--poses", o.set.poses, "N",
                 "Number of poses per class [" + std::to_string(o.set.poses) + "]")
      ->in_range(1, 10000);
  app.add_option("--seed", o.set.seed, "S", "Random seed for the poses [1]")->not_negative();
  app.add_option("--timeout", o.timeout, "S", "Time limit per pose and method, in seconds [20]")
      ->in_range(0.1, 3600.0);
}

void add_quantity_option(App& app, methods::Quantity& quantity) {
  app.add_option_function<std::string>(
      "--quantity",
      [&quantity](const std::string& word) {
        const auto known = from_name<methods::Quantity>(word);
        if (!known) reject_value("--quantity", "'" + word + "': expected " + all_names<methods::Quantity>());
        quantity = *known;
      },
      "Q", "Quantity to compute: " + all_names<methods::Quantity>() + " [pairs]");
}

Contest make_contest(const std::string& a, const std::string& b, std::vector<std::string> names,
                     double timeout) {
  if (names.empty()) names = {"ours"};
  const std::string kCommand = "command:";
  const bool others =
      std::any_of(names.begin(), names.end(), [&](const std::string& n) { return !n.starts_with(kCommand); });
  const std::vector<workers::WorkerMethod> known =
      others ? workers::find_methods() : std::vector<workers::WorkerMethod>{};
  auto bodies = std::make_unique<std::array<bodies::LoadedBody, 2>>(bodies::load_faces_of_two(a, b));
  for (std::size_t i = 0; i < 2; ++i)
    if ((*bodies)[i].rep.dim() != 3)
      throw InputError(printable_name(i == 0 ? a : b) + ": expected a 3D body, found a 2D body");
  const std::chrono::duration<double> limit(timeout);
  std::vector<std::unique_ptr<engines::Engine>> engines;
  for (const std::string& name : names) {
    if (name.starts_with(kCommand)) {
      engines.push_back(engines::command_engine(name.substr(kCommand.size()), a, b, limit));
    } else {
      const workers::WorkerMethod method = chosen_methods(known, {name}).front();
      if (!method.info.pairs)
        throw InputError("method '" + name + "': expected one that lists all pairs, found one that does not");
      engines.push_back(engines::worker_engine(method, a, b, limit));
    }
  }
  const engines::PoseSpace space(shapes::box_of((*bodies)[0].rep), shapes::box_of((*bodies)[1].rep));
  return {std::move(bodies), space, std::move(engines)};
}

void write_scenario(const Contest& contest, const std::array<std::string, 2>& files,
                    const std::string& purpose, const std::vector<Pose>& poses, const std::string& folder) {
  namespace fs = std::filesystem;
  const auto from_folder = [&](const std::string& file) {
    return fs::relative(fs::absolute(file), fs::absolute(folder)).string();
  };
  const std::string path = folder + "/worst.scenario.json";
  io::write_text(path,
                 engines::scenario_text(purpose, poses, (*contest.bodies)[0].rep, (*contest.bodies)[1].rep,
                                        from_folder(files[0]), from_folder(files[1])));
  print(path + "\n");
}

void print_rows(const std::string& title, const engines::Rows& rows, bool json) {
  if (!json) return print(title + "\n" + rows.table);
  for (const std::string& line : rows.lines) print(line);
}

}  // namespace lrb::tools
