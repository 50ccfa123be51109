#pragma once
/// The price of each visit of a captured query: its contribution to the answer.
///
/// A visit is a test of two nodes' volumes (of wide nodes: the comparison of all their children, which counts
/// once), and has one of these prices:
/// - needed: two intersecting triangles lie beneath the nodes. Any descent of these trees visits such pairs.
/// - proof: the first pair beneath a needed one beneath which nothing intersects. Volumes that fit perfectly
///   would end the descent here. Together with the needed visits it is a proof of the answer.
/// - test: the rest of the visits beneath a pair of disjoint volumes, of which the engine's test said that
///   they overlap. A test on more axes, or without the error of a fast one, would end the descent there.
/// - volumes: visits beneath a pair of proof that no order of descent avoids with these volumes:
///   least_visits() minus the needed visits and the visits of proof.
/// - order: the rest of the visits beneath a pair of proof. Another choice of the node to open would have
///   saved them; a repeated visit was not necessary at all. An oracle makes this choice, so this is a bound.
/// - unsplit: volumes and order together, if least_visits() was not requested or has no answer.
/// - unattributed: the visit does not descend from a start (QueryWalk::is_start()).
///   All visits of queries of first contact, whose tests have another meaning, and of queries with a side
///   without a tree.
///
/// A query of kind any that found an intersection needs the visits above the pairs that it found, and nothing
/// else: all other visits are of order. An oracle would go straight to a pair.
///
/// A query of distance that computes the exact distance d has to come to one closest pair of triangles:
/// - needed: the visits above the closest pair that the engine tested first.
/// - proof: the first pair beneath a needed one without that closest pair beneath.
/// - volumes: visits beneath a pair of proof whose volumes, and those of all pairs between, are closer than
/// d.
///   No engine with these volumes and this descent rule ends the descent above them.
/// - order: the rest. If d had been known from the start, the descent would have ended above these visits: a
///   closer pair found earlier saves them.
/// If the bodies intersect, d is 0, and all visits but the needed ones are of order. For the first hit of a
/// ray, the closest pairs are the first hits, and volumes count as closer than d if the ray meets them up to
/// there.
///
/// Tests of triangles are counted separately. A test of triangles that do not intersect is a test for
/// nothing.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/profile/query_walk.hpp"
#include <lrbscope/workspace.hpp>

namespace lrb::profile {

/// Returns the least number of visits that any order of descent needs with the volumes of these trees;
/// nullopt for more than 50 million pairs of nodes or 4000 levels.
///
/// A descent begins where the recorded one did, usually with both roots. At a pair whose volumes overlap it
/// opens A's node, or B's, or both if the recorded engine ever did so. It then visits all pairs of children
/// (QueryWalk::wide(): those whose volumes overlap, because they were compared before). The order in which
/// pairs are visited makes no difference: it visits until nothing is left, so this is not for queries that
/// may end early.
///
/// Volumes overlap if the recorded test said so, if any, and overlap() agrees.
///
/// Dynamic programming over pairs of nodes: the least number beneath a pair is 1, plus that of the pairs of
/// children for the best choice. Parts of a choice that cannot become the best are skipped.
///
/// `saved`: the number of recorded tests of triangles in pairs of leaves that this descent does not reach.
std::optional<std::uint64_t> least_visits(CapturedBodies& bodies, const QueryWalk& walk,
                                          std::uint64_t* saved = nullptr);

/// Sizes of larger leaves that Prices::saved_by_leaves is about.
inline constexpr std::array<std::uint32_t, 3> kLargerLeaves{2, 4, 8};

struct Prices {
  std::uint64_t visits = 0;  ///< the sum of the following seven
  std::uint64_t needed = 0, proof = 0, test = 0, volumes = 0, order = 0, unsplit = 0, unattributed = 0;
  std::uint64_t volume_tests = 0;  ///< sum over all visits; exceeds `visits` for wide nodes
  std::uint64_t triangle_tests = 0, triangle_tests_for_nothing = 0;
  /// Needless tests in pairs of leaves with more than one pair of triangles, which smaller leaves might
  /// save. Excludes triangles whose own volumes were compared, as at leaves of wide nodes.
  std::uint64_t crowded_tests = 0;
  /// Tests of triangles that would end with the visits of a price: all beneath pairs of nodes beneath which
  /// nothing intersects; those beneath disjoint volumes; those that the best order does not reach.
  std::uint64_t triangles_by_volumes = 0, triangles_by_test = 0, triangles_by_order = 0;
  /// An estimate of the visits and tests of triangles that leaves of up to kLargerLeaves triangles would
  /// save: for each first visited pair of nodes of that size whose volumes overlap, the visits and tests
  /// beneath it, less the tests of all its pairs of triangles.
  std::array<std::int64_t, kLargerLeaves.size()> saved_by_leaves{};

  std::uint64_t wasted() const { return test + volumes + order + unsplit; }
  Prices& operator+=(const Prices& other);
  friend bool operator==(const Prices&, const Prices&) = default;
};

/// The names of the counts in JSON.
inline constexpr std::pair<const char*, std::uint64_t Prices::*> kPriceCounts[] = {
    {"visits", &Prices::visits},
    {"needed", &Prices::needed},
    {"proof", &Prices::proof},
    {"test", &Prices::test},
    {"volumes", &Prices::volumes},
    {"order", &Prices::order},
    {"unsplit", &Prices::unsplit},
    {"unattributed", &Prices::unattributed},
    {"volume_tests", &Prices::volume_tests},
    {"triangle_tests", &Prices::triangle_tests},
    {"triangle_tests_for_nothing", &Prices::triangle_tests_for_nothing},
    {"crowded_tests", &Prices::crowded_tests},
    {"triangles_by_volumes", &Prices::triangles_by_volumes},
    {"triangles_by_test", &Prices::triangles_by_test},
    {"triangles_by_order", &Prices::triangles_by_order},
};

/// Prices of queries, added up.
class PriceBook {
 public:
  /// `bodies` must outlive this object.
  explicit PriceBook(CapturedBodies& bodies) : bodies_(bodies) {}

  /// Prices a query, and adds it to the sums. `walk`: of the query; nullptr for a side without a tree.
  /// `exact`: the intersecting pairs of triangles, ascending. `split`: search for the least number of visits,
  /// which takes longer than all the rest.
  Prices add(const capture::Query& query, const QueryWalk* walk, std::span<const TrianglePair> exact,
             bool split);

  /// Returns the waste by triangle of a tree's mesh. Half of each wasted visit goes to either node, and is
  /// shared evenly by the triangles beneath. The sum over all trees is the number of wasted visits.
  std::vector<double> waste_by_triangle(std::uint32_t tree);

 private:
  /// `goals`: the pairs of triangles that the descent has to come to. Waste is unsplit or, if it would be
  /// saved by an engine that knows the `distance` from the start, of order.
  void price_visits(const QueryWalk& walk, std::span<const TrianglePair> goals, bool one_is_enough,
                    std::optional<double> distance, Prices& out);
  void price_distance(const QueryWalk& walk, std::span<const TrianglePair> exact, bool split, Prices& out);
  void price_leaves(const QueryWalk& walk, Prices& out);

  CapturedBodies& bodies_;
  Workspace workspace_;
  std::map<std::uint32_t, std::vector<double>> waste_of_nodes_;  ///< by tree
};

/// Returns a sentence that says which change would save most of the tests of volumes and triangles, each
/// counted as one, and at most what share; and which comes next. Volumes could save the visits of all other
/// prices too if they fitted perfectly: they are ranked by those that no order saves, without the tests of
/// triangles that smaller leaves would save, and the sentence has both numbers.
std::string advice(const Prices& sum);

}  // namespace lrb::profile
