#pragma once
/// Explanations as text and as JSON, which `lrbscope why` prints; and those of a run's pairs of faces, and of
/// its steps without pairs, for its page (report/web/scene_panels.js).

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "scenarios/frames/frames.hpp"
#include <lrbscope/explain.hpp>

namespace lrb::run {

/// Explain why two faces are or are not in an answer, as lines of text and as a JSON object.
std::string explanation_text(const PairExplanation& e, const LrbRep& a, const LrbRep& b);
nlohmann::ordered_json explanation_json(const PairExplanation& e, const LrbRep& a, const LrbRep& b);

/// Explain the result of a query, including the proof that two bodies are separate.
std::string explanation_text(const WalkExplanation& e);
nlohmann::ordered_json explanation_json(const WalkExplanation& e);

// Phrases of explanations, common to the program and the pages.

/// Names the test that decided about two faces of bodies of `dim` dimensions, as a phrase that follows
/// "decided by".
std::string_view to_text(DecidedBy by, int dim);

/// The frame of a page's view: x_page = (x - origin) / unit, in floats.
struct SceneFrame {
  Eigen::Vector3d origin{0, 0, 0};
  double unit = 1;

  void add_point(std::vector<float>& out, const Eigen::Vector3d& x) const { add(out, (x - origin) / unit); }
  /// Appends a vector.
  void add_vector(std::vector<float>& out, const Eigen::Vector3d& v) const { add(out, v / unit); }

 private:
  static void add(std::vector<float>& out, const Eigen::Vector3d& x) {
    for (int i = 0; i < 3; ++i) out.push_back(static_cast<float>(x[i]));
  }
};

/// Maximum number of explanations on a page.
struct ExplainLimits {
  std::size_t pairs = 8'000;
  std::size_t steps = 200;
};

/// The events and steps on the page, which are explained. Ascending.
struct Explained {
  const std::vector<trace::EventId>& events;
  const std::vector<std::uint32_t>& steps;
};

/// Returns the results of explain_pair() for the pairs of real faces that these events compare, or that
/// another engine got wrong, once for each step and pair, and explain_walk() for the steps without
/// pairs. If there are too many pairs, contacts come first; others are evenly chosen. `command` explains
/// other pairs, see ReportText::why. Returns null for a run of one body, and for requests that the complete
/// query does not answer.
nlohmann::json explanations_json(const frames::RecordedRun& recorded, const Explained& what,
                                 const SceneFrame& frame, const std::string& command,
                                 const ExplainLimits& limits = {});

}  // namespace lrb::run
