#pragma once
/// Options shared by the commands that measure other engines.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bench/engines/costs.hpp"
#include "bench/speed/make_sets.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "tools/options.hpp"

namespace lrb::tools {

/// Returns the named methods, as chosen(). Throws EnvironmentError if one of those named is absent from this
/// build.
std::vector<workers::WorkerMethod> chosen_methods(const std::vector<workers::WorkerMethod>& all,
                                                  const std::vector<std::string>& names);

struct MeasureOptions {
  std::string folder, folder_help, models;
  std::vector<std::string> methods;
  speed::SetOptions set;
  double timeout = 20;
  bool tex = false;
};

/// Adds the options; the help shows the values in `o` as defaults.
void add_measure_options(App& app, MeasureOptions& o);
/// Adds --quantity: the quantity that methods are compared on.
void add_quantity_option(App& app, methods::Quantity& quantity);

/// Two bodies, and engines that find their pairs.
struct Contest {
  std::unique_ptr<std::array<bodies::LoadedBody, 2>> bodies;
  engines::PoseSpace space;
  std::vector<std::unique_ptr<engines::Engine>> engines;
};

/// Reads two bodies and prepares the engines: `ours`, methods of worker programs, `command:PROGRAM`; without
/// any, ours. `timeout`: seconds per pose of a method, and per start of a program. Throws InputError for
/// bodies that are not 3D and for an unknown method, and EnvironmentError for an absent one.
Contest make_contest(const std::string& a, const std::string& b, std::vector<std::string> names,
                     double timeout);

/// Writes folder/worst.scenario.json: the poses, with the exact answers as expectations.
void write_scenario(const Contest& contest, const std::array<std::string, 2>& files,
                    const std::string& purpose, const std::vector<Pose>& poses, const std::string& folder);

/// Prints a title and a table, or JSON.
void print_rows(const std::string& title, const engines::Rows& rows, bool json);

}  // namespace lrb::tools
