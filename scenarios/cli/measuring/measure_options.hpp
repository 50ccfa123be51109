#pragma once
/// The options that commands which measure share.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "scenarios/bench/make_sets.hpp"

namespace lrb::cli {

struct MeasureOptions {
  std::string folder, folder_help, models;
  std::vector<std::string> methods;
  bench::SetOptions set;
  double timeout = 20;
};

/// Adds the options; the help names the values in `o` as defaults.
inline void add_measure_options(CLI::App& app, MeasureOptions& o) {
  app.add_option("-o,--output", o.folder,
                 "Folder to write to; a survey that it holds is continued [" + o.folder_help + "]")
      ->type_name("DIR");
  app.add_option("--models", o.models, "Folder of meshes to collide as well, each with the next one")
      ->type_name("DIR");
  app.add_option("--method", o.methods, "Only these methods")->type_name("NAME");
  app.add_option("--poses", o.set.poses,
                 "Number of poses of each class [" + std::to_string(o.set.poses) + "]")
      ->check(CLI::Range(1, 10000))
      ->type_name("N");
  app.add_option("--seed", o.set.seed, "Seed of the poses [1]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  app.add_option("--timeout", o.timeout, "Seconds that a method has for a pose [20]")
      ->check(CLI::Range(0.1, 3600.0))
      ->type_name("S");
}

/// Adds --quantity: what methods are asked for.
inline void add_quantity_option(CLI::App& app, methods::Quantity& quantity) {
  app.add_option_function<std::string>(
         "--quantity",
         [&quantity](const std::string& word) {
           const auto known = from_name<methods::Quantity>(word);
           if (!known)
             throw CLI::ValidationError("--quantity",
                                        "'" + word + "': use " + all_names<methods::Quantity>());
           quantity = *known;
         },
         "What to ask for: pairs (the default), distance, first_contact, depth")
      ->type_name("Q");
}

}  // namespace lrb::cli
