#pragma once
/// The motions that sweep_bench puts to all methods: two poses or a series of them, which FCL can be asked
/// about as well, and for some of them the time of first contact in closed form.

#include <optional>
#include <string>
#include <vector>

#include <lrbscope/first_contact.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::bench {

/// A motion of B; A stands still at the origin.
struct SweptMotion {
  Motion motion;
  bool straight = true;  ///< it does not turn
  /// In FCL's terms: from each pose to the next one, turning by less than half a turn about B's origin, which
  /// moves straight. The poses are equally far apart in time.
  std::vector<Pose> stations;
  /// Holds the time of first contact in closed form; 2: never.
  std::optional<TimeSpan> known;
};

/// Bodies, and motions of one kind.
struct SweptFamily {
  std::string name, what;
  LrbRep a, b;
  std::vector<SweptMotion> motions;
};

/// Returns all families, `count` motions in each; those of `mesh`, if it is not empty, among them.
std::vector<SweptFamily> swept_families(int count, const std::string& mesh);

}  // namespace lrb::bench
