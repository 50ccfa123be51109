#pragma once
/// The paper's experiment as a file: bodies, protocol and contents of the report.
/// schema/experiment.schema.json describes the format; shipped/*.experiment.json contain the published
/// numbers.

#include <string>
#include <vector>

#include "scenarios/bodies/resolutions.hpp"
#include "scenarios/paper/protocol.hpp"
#include "scenarios/paper/sweep.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/core/fields.hpp>

namespace lrb::paper {

/// Parts of the report. `settings`: table 2 for other time steps and numbers of steps; `structures`: the
/// other structures that the paper names, if the program has them; `incremental`: wrappers kept between
/// steps.
enum class PaperPart : std::uint8_t {
  table1,
  table2,
  figure_3_1,
  figure_3_2,
  settings,
  structures,
  incremental,
  heat_maps,
  refinement_tree
};
constexpr auto enum_names(PaperPart) {
  return std::to_array<EnumName<PaperPart>>({{PaperPart::table1, "table1"},
                                             {PaperPart::table2, "table2"},
                                             {PaperPart::figure_3_1, "figure3.1"},
                                             {PaperPart::figure_3_2, "figure3.2"},
                                             {PaperPart::settings, "settings"},
                                             {PaperPart::structures, "structures"},
                                             {PaperPart::incremental, "incremental"},
                                             {PaperPart::heat_maps, "heat_maps"},
                                             {PaperPart::refinement_tree, "refinement_tree"}});
}

struct PaperExperiment {
  struct Object {
    std::string name;
    spec::BodySpec body;
  };
  std::string name, purpose;
  PaperProtocol protocol;
  std::vector<Object> objects;    ///< the first one collides with all others
  std::vector<PaperPart> report;  ///< in the order of the enum
  std::string close_up;           ///< the object of heat maps and refinement tree

  bool reports(PaperPart part) const;
  /// Returns true if any part needs a collision.
  bool collides() const;
};

/// Reads an experiment. Throws InputError: "file:line:column: pointer: fault, valid values".
PaperExperiment parse_experiment(const std::string& text, const std::string& file);
/// Reads a shipped experiment by its name, or one from a file.
PaperExperiment open_experiment(const std::string& name_or_path);
/// Returns the text of a shipped experiment, as a starting point for new ones. Throws InputError for an
/// unknown name.
std::string shipped_experiment(const std::string& name);
std::vector<std::string> shipped_experiments();

/// Makes its bodies, all scaled to the first one's diagonal. Appends the changes made to them to `notes`.
/// Throws InputError for bodies that are not 3D.
std::vector<PaperObject> make_objects(const PaperExperiment& experiment, std::vector<std::string>& notes);

}  // namespace lrb::paper

namespace lrb {

// The tables of fields of the experiment's records and settings.

template <>
inline constexpr auto kFields<paper::PaperProtocol> =
    std::tuple{field("collisions", &paper::PaperProtocol::collisions),
               field("time_step_of_diagonal", &paper::PaperProtocol::step),
               field("steps_after_first_contact", &paper::PaperProtocol::steps_after),
               field("seed", &paper::PaperProtocol::seed), field("seeds", &paper::PaperProtocol::seeds)};
static_assert(covers_all_fields<paper::PaperProtocol>);

/// Without the duration of a recursion, which is not reproducible and has a separate file.
template <>
inline constexpr auto kFields<paper::RecursionCount> =
    std::tuple{field("comparisons", &paper::RecursionCount::comparisons),
               field("triangles", &paper::RecursionCount::triangles, Kept::if_set),
               field("refinements", &paper::RecursionCount::refinements),
               field("pairs", &paper::RecursionCount::pairs),
               field("missed", &paper::RecursionCount::missed),
               field("bound_tests", &paper::RecursionCount::bound_tests)};

/// Without `min_faces`, which experiments do not set.
template <>
inline constexpr auto kFields<resolutions::ResolutionOptions> =
    std::tuple{field("resolutions", &resolutions::ResolutionOptions::most),
               field("subdivisions", &resolutions::ResolutionOptions::subdivisions)};

}  // namespace lrb
