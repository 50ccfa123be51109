#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/collide/collide_into.hpp"
#include "tests/support/rational_oracle.hpp"
#include "tests/torture/cgal_oracle.hpp"
#include "tests/torture/parity_oracle.hpp"
#include "tests/torture/torture.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>

namespace lrb::torture {
namespace {

class Comparison {
 public:
  Comparison(const cases::Case& c, RandomEngine& random, const Effort& effort, std::string& trouble)
      : c_(c), random_(random), effort_(effort), trouble_(trouble) {}

  Tally run() {
    ++t_.poses;
    try {
      CollideRequest everything;
      everything.contacts = true;
      // For large bodies this takes longer than all else together.
      everything.interiors_overlap = c_.interiors_overlap.has_value() ||
                                     simplex_pairs() <= effort_.small_pairs ||
                                     random_() % effort_.interiors_every == 0;
      all_ = ask(everything, false);
    } catch (const InputError& e) {
      ++t_.rejections;
      check_refusal(e.what());
      return t_;
    }
    brute_ = brute_force(*c_.a, c_.pose_a, *c_.b, c_.pose_b);
    t_.in_contact += !brute_.pairs.empty();
    t_.inside += is_inside(brute_.relation);
    compare_pairs();
    compare_first();
    compare_swapped();
    compare_relation();
    check_contacts();
    ask_oracles();
    if (brute_.pairs.empty() && random_() % static_cast<unsigned>(effort_.parity_every) == 0) ask_parity();
    if (c_.a->region_count() + c_.b->region_count() > 0) check_coarse(c_, brute_, random_, t_, trouble_);
    if (random_() % effort_.motions_every == 0 && simplex_pairs() <= effort_.motions_most_pairs)
      check_motion(c_, random_, t_, trouble_);
    return t_;
  }

 private:
  static QueryContext& context() {
    static QueryContext kept;  // reused from case to case, as a program would
    return kept;
  }

  CollideResult ask(const CollideRequest& request, bool swapped) const {
    NullProbe probe;
    return swapped ? collide(*c_.b, c_.pose_b, *c_.a, c_.pose_a, request, context(), probe)
                   : collide(*c_.a, c_.pose_a, *c_.b, c_.pose_b, request, context(), probe);
  }

  void complain(std::uint64_t& counter, const std::string& what, std::uint64_t times = 1) {
    torture::complain(counter, trouble_, what, times);
  }

  /// A refusal is right only where a world coordinate is not finite.
  void check_refusal(const std::string& what) {
    bool finite = true;
    for (const auto& [rep, pose] : {std::pair{c_.a, c_.pose_a}, std::pair{c_.b, c_.pose_b}})
      for (const auto& v : rep->vertices()) finite &= pose.apply(v).allFinite();
    if (finite) complain(t_.crashes, "refused finite coordinates: " + what);
    if (what.find('\n') != std::string::npos || what.find("vertex") == std::string::npos)
      complain(t_.crashes, "a refusal must name the vertex in one line: " + what);
  }

  std::uint64_t simplex_pairs() const {
    return std::uint64_t{c_.a->real_simplex_count()} * std::uint64_t{c_.b->real_simplex_count()};
  }

  void compare_pairs() {
    std::vector<SimplexPair> missing, extra;
    std::set_difference(brute_.pairs.begin(), brute_.pairs.end(), all_.pairs.begin(), all_.pairs.end(),
                        std::back_inserter(missing));
    std::set_difference(all_.pairs.begin(), all_.pairs.end(), brute_.pairs.begin(), brute_.pairs.end(),
                        std::back_inserter(extra));
    complain(t_.false_negatives, "pairs missed against brute force", missing.size());
    complain(t_.false_positives, "pairs too many against brute force", extra.size());
    if (missing.empty() && extra.empty() && (all_.pairs != brute_.pairs || all_.meets != brute_.meets))
      complain(t_.wrong_lists, "pairs repeated, out of order or classified differently");
  }

  void compare_first() {
    CollideRequest request;
    request.mode = Mode::first_pair;
    const CollideResult one = ask(request, false);
    if (one.pairs.size() != std::min<std::size_t>(1, brute_.pairs.size()) ||
        !std::includes(brute_.pairs.begin(), brute_.pairs.end(), one.pairs.begin(), one.pairs.end()))
      complain(t_.wrong_lists, "first_pair: not one of the pairs");
    if (one.relation != brute_.relation) complain(t_.wrong_relations, "first_pair: another relation");
  }

  void compare_swapped() {
    const CollideResult swapped = ask({}, true);
    std::vector<SimplexPair> back;
    for (const SimplexPair& p : swapped.pairs) back.push_back({p.b, p.a});
    std::sort(back.begin(), back.end());
    if (back != brute_.pairs) complain(t_.wrong_lists, "B against A: another list");
    // Where each body holds a piece of the other, the first of the query is named as the one inside.
    const bool mutual = swapped.relation == Relation::a_inside_b && brute_.relation == Relation::a_inside_b &&
                        c_.a->component_vertices().size() > 1 && c_.b->component_vertices().size() > 1;
    if (swapped.relation != mirrored(brute_.relation) && !mutual)
      complain(t_.wrong_relations, "B against A: another relation");
  }

  void compare_relation() {
    const std::string got = to_string(all_.relation);
    if (all_.relation != brute_.relation)
      complain(t_.wrong_relations, got + ", brute force says " + to_string(brute_.relation));
    if (c_.relation && all_.relation != *c_.relation)
      complain(t_.wrong_relations, got + ", made to be " + to_string(*c_.relation));
    if (!c_.interiors_overlap) return;
    if (all_.interiors_overlap == Answer::unknown)
      complain(t_.undecided, got + ", interiors_overlap unknown");
    else if ((all_.interiors_overlap == Answer::yes) != *c_.interiors_overlap)
      complain(t_.wrong_relations,
               got + ", interiors_overlap " + to_string(all_.interiors_overlap) + " is wrong");
  }

  /// Areas of bodies over 1e150 in size, and lengths near 1e308, are no doubles: infinity is their right
  /// value.
  bool is_sound(const ContactRegion& r) const {
    bool sound = r.centroid.allFinite() && r.normal.allFinite();
    const Eigen::AlignedBox3d box = box_of(r);
    const bool large = box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff() > 1e140;
    for (const double x : {r.length, r.area, r.depth_estimate})
      sound &= large ? !std::isnan(x) : std::isfinite(x);
    for (const ContactLoop& loop : r.loops)
      for (const auto& p : loop.points) sound &= p.allFinite();
    return sound;
  }

  /// Records for all pairs, regions that share them out, numbers that are numbers, centroids where the bodies
  /// are.
  void check_contacts() {
    if (all_.contacts.size() != all_.pairs.size()) complain(t_.wrong_lists, "a pair without its contact");
    for (std::size_t i = 0; i < std::min(all_.contacts.size(), all_.meets.size()); ++i)
      if (all_.contacts[i].meet != all_.meets[i] || all_.contacts[i].corner_count == 0)
        complain(t_.wrong_lists, "a contact that contradicts its pair");
    std::vector<std::uint32_t> seen;
    for (const ContactRegion& r : all_.regions) {
      seen.insert(seen.end(), r.pairs.begin(), r.pairs.end());
      const double n = r.normal.norm();
      if (!is_sound(r)) complain(t_.wrong_lists, "a contact region with a number that is not finite");
      if (r.area < 0 || r.length < 0 || r.depth_estimate < 0 || (n != 0 && std::abs(n - 1) > 1e-9))
        complain(t_.wrong_lists, "a contact region with an impossible number");
      if (!near_its_points(r)) complain(t_.wrong_lists, "a contact region whose centroid is off");
    }
    std::sort(seen.begin(), seen.end());
    bool each_once = seen.size() == all_.pairs.size();
    for (std::size_t i = 0; i < seen.size() && each_once; ++i) each_once = seen[i] == i;
    if (!each_once) complain(t_.wrong_lists, "contact regions do not share out the pairs");
  }

  Eigen::AlignedBox3d box_of(const ContactRegion& r) const {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t i : r.pairs)
      for (int k = 0; k < all_.contacts[i].corner_count; ++k) box.extend(all_.contacts[i].corners[k].x);
    return box;
  }

  bool near_its_points(const ContactRegion& r) const {
    const Eigen::AlignedBox3d box = box_of(r);
    Eigen::Vector3d slack = 1e-9 * box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs());
    slack.array() += 1e-320;  // denormals are rounded to their last place
    return (r.centroid.array() >= (box.min() - slack).array()).all() &&
           (r.centroid.array() <= (box.max() + slack).array()).all();
  }

  /// Asks about some pairs: half of them from the answer, the others whose boxes meet but are not in it.
  void ask_oracles() {
    const auto xa = world_points(*c_.a, c_.pose_a), xb = world_points(*c_.b, c_.pose_b);
    const std::size_t tries = 8 * effort_.oracle_pairs;
    std::size_t checked = 0;
    for (std::size_t i = 0; i < tries && checked < effort_.oracle_pairs; ++i) {
      SimplexPair p{static_cast<SimplexId>(random_() % c_.a->real_simplex_count()),
                    static_cast<SimplexId>(random_() % c_.b->real_simplex_count())};
      if (i % 2 == 0 && !brute_.pairs.empty()) p = brute_.pairs[random_() % brute_.pairs.size()];
      const auto ca = corners_of(*c_.a, xa, p.a), cb = corners_of(*c_.b, xb, p.b);
      if (boxes_disjoint(ca.data(), cb.data(), c_.a->dim())) continue;
      ++checked;
      ask_oracle(p, ca.data(), cb.data());
    }
  }

  void ask_oracle(const SimplexPair& p, const double* const a[3], const double* const b[3]) {
    const auto found = std::lower_bound(all_.pairs.begin(), all_.pairs.end(), p);
    const bool listed = found != all_.pairs.end() && *found == p;
    const int meet = oracle::meet_of_simplices(a, b, static_cast<std::size_t>(c_.a->dim()));
    ++t_.oracle_pairs;
    if (meet != 0 && !listed) complain(t_.false_negatives, "a pair missed against the rational oracle");
    if (meet == 0 && listed) complain(t_.false_positives, "a pair too many against the rational oracle");
    if (meet != 0 && listed && static_cast<int>(all_.meets[found - all_.pairs.begin()]) != meet)
      complain(t_.wrong_lists, "touch for cross against the rational oracle, or the reverse");
    const int cgal = c_.a->dim() == 3 ? cgal_triangles_meet(a, b) : -1;
    if (cgal < 0) return;
    ++t_.cgal_pairs;
    if (cgal != listed) complain(cgal ? t_.false_negatives : t_.false_positives, "CGAL disagrees");
  }

  void ask_parity() {
    for (const auto& [rep, pose] : {std::pair{c_.a, c_.pose_a}, std::pair{c_.b, c_.pose_b}})
      for (const auto& v : rep->vertices())
        if (!(pose.apply(v).cwiseAbs().maxCoeff() < 1e300)) return;  // no room for a point farther off
    ++t_.parity_checks;
    const Relation r = relation_by_parity(*c_.a, c_.pose_a, *c_.b, c_.pose_b, random_);
    if (r != all_.relation)
      complain(t_.wrong_relations,
               std::string(to_string(all_.relation)) + ", the parity oracle says " + to_string(r));
  }

  const cases::Case& c_;
  RandomEngine& random_;
  const Effort& effort_;
  std::string& trouble_;
  Tally t_;
  CollideResult all_;
  BruteForceResult brute_;
};

}  // namespace

Tally check(const cases::Case& c, RandomEngine& random, const Effort& effort, std::string& trouble) {
  return Comparison(c, random, effort, trouble).run();
}

}  // namespace lrb::torture
