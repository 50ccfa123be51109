#pragma once
/// What is kept of further questions about a step: how far apart the bodies are, what kind of contact they
/// have, and how the bounds tightened while that was found out; and of the search for the first contact of a
/// whole motion.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/query/clash/clash_probe.hpp"
#include "engine/query/motion/first_contact_probe.hpp"

namespace lrb::trace {

/// A DistanceResult without its features.
struct MeasuredDistance {
  double lower = 0, upper = 0;                    ///< hold the distance of the surfaces; 0 if they meet
  bool solids_meet = false;                       ///< the surfaces do, or a body holds the other
  std::array<std::array<double, 3>, 2> points{};  ///< of A's surface and of B's, `upper` apart
  std::vector<Bounds> course;

  friend bool operator==(const MeasuredDistance&, const MeasuredDistance&) = default;
};

/// A ClashResult without the pieces of the surfaces.
struct MeasuredClash {
  ClashKind kind = ClashKind::undecided;
  ClashReason reason = ClashReason::none;
  bool shares_faces = false;
  std::array<double, 2> distance{};                    ///< of the solids
  std::optional<std::array<double, 2>> depth, volume;  ///< intervals; none: not known
  std::array<double, 3> translation{};                 ///< of B, that parts the solids
  std::vector<Bounds> course;                          ///< of the depth

  friend bool operator==(const MeasuredClash&, const MeasuredClash&) = default;
};

/// When the bodies first meet on the way that the steps are taken from, as a share of it.
struct MeasuredApproach {
  MotionOutcome outcome = MotionOutcome::undecided;
  double t0 = 0, t1 = 0;  ///< as FirstContactResult has them
  /// The same two times as steps of the trace: 11.36 is after step 11 and before step 12. Below 0 if the
  /// contact comes before step 0. None: no contact.
  std::optional<std::array<double, 2>> step;
  std::optional<std::array<double, 2>> length;  ///< the way that B's origin has moved from step 0 by then
  std::vector<ContactBounds> course;            ///< empty unless the search was watched

  friend bool operator==(const MeasuredApproach&, const MeasuredApproach&) = default;
};

MeasuredDistance measured(const DistanceResult& result, std::vector<Bounds> course);
MeasuredClash measured(const ClashResult& result, std::vector<Bounds> course);
/// Leaves step and length out, which the steps of the trace decide.
MeasuredApproach measured(const FirstContactResult& result, std::vector<ContactBounds> course);

/// Return it in a few words: "[0.25, 0.25] in 31 looks".
std::string words(const MeasuredDistance& m);
std::string words(const MeasuredClash& m);
std::string words(const MeasuredApproach& m);

}  // namespace lrb::trace
