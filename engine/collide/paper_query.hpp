#pragma once
/// The paper's query (section 4, "The 2-Body Collision Algorithm"), to the letter: all outermost faces of one
/// wrapper are tested against all of the other; faces that intersect are refined, and their new faces are
/// tested recursively.
///
/// It is not complete: a contact under lids that are not touched is never reached (a ball in a bowl, or a
/// body that entered through the solid side). It exists to reproduce the paper's figures and to show these
/// failures.
///
/// The paper does not define "the new faces are recursively tested" for a region that was refined before ("a
/// region or even an individual face can only be refined once"). Three readings are implemented:
/// - Recursion::paper: each *pair* of regions (or of a real face and a region) is recursed into at most once.
///   The floor of a refined region is tested again when another region of the other body intersects its lids.
/// - Recursion::paper_strict: the floor of a region is tested only when the region is first refined, against
///   the new faces (or the real face) of the other body, and never again.
/// - Recursion::paper_wrapper: the new faces are tested against the whole current wrapper of the other
///   body. A pair is tested if both faces are still part of their wrappers.
///
/// Two forms with a box around each floor, in which only the larger of two regions is refined, serve as
/// queries on LRB-reps with small regions (BuildOptions::max_lids); see test_floors():
/// - Recursion::paper_boxes: its floor is tested against one list of faces of the other body.
/// - Recursion::paper_wrapper_boxes: against the whole current wrapper of the other body.

#include <array>
#include <deque>
#include <set>
#include <span>
#include <vector>

#include "engine/collide/boxed_floors.hpp"
#include "engine/collide/kept_gaps.hpp"
#include "engine/collide/query_context.hpp"

namespace lrb {

template <class Probe>
class PaperQuery {
 public:
  PaperQuery(QueryContext& ctx, const CollideRequest& request, CollideResult& result, Probe& probe)
      : ctx_(ctx), request_(request), result_(result), probe_(probe) {
    for (auto& set : ctx_.visited) set.clear();
  }

  void run() {
    const Faces as = ctx_[Side::a].rep().outermost_faces(), bs = ctx_[Side::b].rep().outermost_faces();
    switch (request_.recursion) {
      case Recursion::paper_boxes:
      case Recursion::paper_wrapper_boxes:
        return test_floors();
      case Recursion::paper_wrapper:
        return test_wrappers(as, bs);
      default:
        return test_all(as, bs);
    }
  }

 private:
  using Faces = std::span<const FaceId>;
  enum Visited { kRegionRegion = 0, kFaceRegion = 1, kRegionFace = 2 };

  void test_all(Faces as, Faces bs) {
    for (const FaceId fa : as)
      for (const FaceId fb : bs) {
        if (done_) return;
        if (faces_meet(fa, fb)) resolve(fa, fb);
      }
  }

  /// Handles the three cases of section 4 for a pair of faces that intersect.
  void resolve(FaceId fa, FaceId fb) {
    const LrbRep &a = ctx_[Side::a].rep(), &b = ctx_[Side::b].rep();
    if (!a.is_real(fa) && !b.is_real(fb)) {
      // Case 1: "If faces are pseudo-faces then refine, bringing in new detail. The new faces added to each
      // respective wrapper are then recursively tested."
      const RegionId ra = a.inner_cell(fa).as_region(), rb = b.inner_cell(fb).as_region();
      const bool new_a = refine(Side::a, fa), new_b = refine(Side::b, fb);
      if (strict() ? new_a && new_b : first_visit(kRegionRegion, ra, rb)) test_all(a.floor(ra), b.floor(rb));
    } else if (a.is_real(fa) != b.is_real(fb)) {
      // Case 2: "If one is a real face and the other is a pseudo face, only the pseudo face is refined and
      // the new faces are recursively tested against the real one."
      if (a.is_real(fa)) {
        const RegionId rb = b.inner_cell(fb).as_region();
        const bool is_new = refine(Side::b, fb);
        if (strict() ? is_new : first_visit(kFaceRegion, fa, rb)) test_all(Faces(&fa, 1), b.floor(rb));
      } else {
        const RegionId ra = a.inner_cell(fa).as_region();
        const bool is_new = refine(Side::a, fa);
        if (strict() ? is_new : first_visit(kRegionFace, ra, fb)) test_all(a.floor(ra), Faces(&fb, 1));
      }
    } else {
      // Case 3: "If both faces are real, the faces are stored in a list of pair-faces that will be returned
      // to the contact analysis module. If the application requires to know only whether the objects are in
      // collision, then the algorithm exits declaring a collision."
      record(fa, fb);
      done_ = request_.mode != Mode::all_pairs;
    }
  }

  /// Tests the current wrappers against each other until no face that intersects the other wrapper is a lid.
  void test_wrappers(Faces outer_a, Faces outer_b) {
    std::set<FaceId> wrapper[2] = {{outer_a.begin(), outer_a.end()}, {outer_b.begin(), outer_b.end()}};
    struct Task {
      Side side;  ///< of the new faces
      std::vector<FaceId> fresh, others;
    };
    std::deque<Task> tasks;
    const auto add = [&](Side side, Faces fresh, const auto& others) {
      if (!fresh.empty())
        tasks.push_back({side, {fresh.begin(), fresh.end()}, {others.begin(), others.end()}});
    };
    // Refines the region behind a lid that intersects. Returns the faces that replace its lids.
    const auto open = [&](Side side, FaceId f) {
      const LrbRep& rep = ctx_[side].rep();
      if (rep.is_real(f)) return Faces();
      const RegionId region = rep.inner_cell(f).as_region();
      refine(side, f);
      for (const FaceId lid : rep.lids(region)) wrapper[static_cast<int>(side)].erase(lid);
      return rep.floor(region);
    };
    add(Side::a, outer_a, wrapper[1]);
    for (; !tasks.empty() && !done_; tasks.pop_front()) {
      const bool of_a = tasks.front().side == Side::a;
      for (const FaceId fresh : tasks.front().fresh)
        for (const FaceId other : tasks.front().others) {
          const FaceId fa = of_a ? fresh : other, fb = of_a ? other : fresh;
          if (done_ || !wrapper[0].contains(fa) || !wrapper[1].contains(fb) || !faces_meet(fa, fb)) continue;
          if (ctx_[Side::a].rep().is_real(fa) && ctx_[Side::b].rep().is_real(fb)) {
            record(fa, fb);
            done_ = request_.mode != Mode::all_pairs;
            continue;
          }
          const Faces new_a = open(Side::a, fa), new_b = open(Side::b, fb);
          add(Side::a, new_a, wrapper[1]);
          add(Side::b, new_b, wrapper[0]);
          add(Side::a, new_a, new_b);
          wrapper[0].insert(new_a.begin(), new_a.end());
          wrapper[1].insert(new_b.begin(), new_b.end());
        }
    }
  }

  /// Tests floors against floors; number 0 is the outermost wrapper. Of each, only the faces that may reach
  /// the other's box are tested. Of the regions behind two lids that intersect, the larger one is refined.
  /// - paper_boxes: its floor is tested against the floor with the other lid (or real face). The tests depend
  ///   on no wrapper, only on the two faces.
  /// - paper_wrapper_boxes: its floor is tested against all floors of the other wrapper, and lids of refined
  ///   regions are skipped.
  void test_floors() {
    const bool whole = request_.recursion == Recursion::paper_wrapper_boxes;
    const UnitCube cube = cube_around(ctx_);
    BoxedFloors floors[2] = {{ctx_[Side::a], cube}, {ctx_[Side::b], cube}};
    std::vector<std::uint32_t> shown[2] = {{0}, {0}};  // the floors of refined regions, in order
    std::deque<std::array<std::uint32_t, 2>> pairs = {{0, 0}};
    first_visit(kRegionRegion, 0, 0);
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
      if (first_visit(kRegionRegion, a, b)) pairs.push_back({a, b});
    };
    const auto is_used = [&](Side side, FaceId f) { return !whole || ctx_[side].wrapper->on_boundary(f); };
    // The number of the floor that would replace a lid; 0 for a real face.
    const auto beneath = [&](Side side, FaceId f) {
      const LrbRep& rep = ctx_[side].rep();
      return rep.is_real(f) ? 0 : floors[static_cast<int>(side)].number_of(rep.inner_cell(f).as_region());
    };
    const auto resolve_pair = [&](std::array<std::uint32_t, 2> pair, FaceId fa, FaceId fb) {
      const std::uint32_t under[2] = {beneath(Side::a, fa), beneath(Side::b, fb)};
      if (under[0] == 0 && under[1] == 0) {
        record(fa, fb);
        done_ = request_.mode != Mode::all_pairs;
        return;
      }
      const bool of_a =
          under[0] != 0 && (under[1] == 0 || floors[0].size(under[0]) >= floors[1].size(under[1]));
      const int side = of_a ? 0 : 1;
      const bool is_new = refine(of_a ? Side::a : Side::b, of_a ? fa : fb);
      if (!whole) {
        pair[static_cast<std::size_t>(side)] = under[side];
        add(pair[0], pair[1]);
      } else if (is_new) {
        for (const std::uint32_t other : shown[1 - side]) of_a ? add(under[0], other) : add(other, under[1]);
        shown[side].push_back(under[side]);
      }
    };
    std::uint64_t& tests = result_.counters.box_tests;
    for (; !pairs.empty(); pairs.pop_front()) {
      const auto [a, b] = pairs.front();
      ++tests;
      const OrientedBox box_a = floors[0][a].box, box_b = floors[1][b].box;
      if (proven_disjoint(box_a, box_b)) continue;
      const auto as = floors[0].reaching(
          a, box_b, [&](FaceId f) { return is_used(Side::a, f); }, tests);
      if (as.empty()) continue;
      const auto bs = floors[1].reaching(
          b, box_a, [&](FaceId f) { return is_used(Side::b, f); }, tests);
      for (const FaceId fa : as)
        for (const FaceId fb : bs) {
          if (!is_used(Side::a, fa) || !is_used(Side::b, fb) || !faces_meet(fa, fb)) continue;
          resolve_pair({a, b}, fa, fb);
          if (done_) return;
        }
    }
  }

  bool strict() const { return request_.recursion == Recursion::paper_strict; }

  bool first_visit(Visited kind, std::uint32_t a, std::uint32_t b) {
    return ctx_.visited[kind].insert(std::uint64_t{a} << 32 | b).second;
  }

  /// Refines the region behind a face. Returns true if it was not refined before.
  bool refine(Side side, FaceId f) {
    QueryBody& body = ctx_[side];
    const RegionId r = body.rep().inner_cell(f).as_region();
    const bool is_new = body.wrapper->included(r);
    if (ctx_.gaps != nullptr) ctx_.gaps->reach(side, r);
    if (!body.wrapper->refine_face(f)) return false;
    ++result_.counters.refinements;
    if constexpr (Probe::kEnabled)
      probe_.refine(side, r, is_new ? static_cast<std::uint32_t>(body.rep().floor(r).size()) : 0);
    return is_new;
  }

  /// Tests two faces as polygons, that is, all pairs of simplices of their fans. Counts as one face test and
  /// one event.
  bool faces_meet(FaceId fa, FaceId fb) {
    if (ctx_.gaps != nullptr && ctx_.gaps->are_apart(fa, fb)) return false;
    exact::Meet best = exact::Meet::disjoint;
    SimplexPair which{ctx_[Side::a].rep().first_simplex(fa), ctx_[Side::b].rep().first_simplex(fb)};
    for_each_simplex_pair(fa, fb, [&](SimplexId a, SimplexId b) {
      const exact::Meet meet = test_simplices(ctx_, a, b);
      if (meet > best) {
        best = meet;
        which = {a, b};
      }
      return best == exact::Meet::cross;
    });
    const std::uint32_t depth_a = ctx_[Side::a].depth_of(fa), depth_b = ctx_[Side::b].depth_of(fb);
    const bool real = ctx_[Side::a].rep().is_real(fa) && ctx_[Side::b].rep().is_real(fb);
    count_face_test(real, std::max(depth_a, depth_b), result_.counters);
    if constexpr (Probe::kEnabled) probe_.face_test(which.a, which.b, best, depth_a, depth_b);
    if (ctx_.gaps != nullptr && best == exact::Meet::disjoint) ctx_.gaps->keep(ctx_, fa, fb);
    return best != exact::Meet::disjoint;
  }

  void record(FaceId fa, FaceId fb) {
    for_each_simplex_pair(fa, fb, [&](SimplexId a, SimplexId b) {
      const exact::Meet meet = test_simplices(ctx_, a, b);
      if (meet != exact::Meet::disjoint) record_pair(result_, probe_, a, b, meet);
      if (result_.pairs.size() > request_.pair_limit()) reject_pairs(request_.pair_limit());
      return request_.mode != Mode::all_pairs && !result_.pairs.empty();
    });
  }

  /// Calls visit(a, b) for all pairs of simplices of two faces until it returns true.
  template <class Visit>
  void for_each_simplex_pair(FaceId fa, FaceId fb, Visit visit) {
    const auto range = [](const LrbRep& rep, FaceId f) {
      const SimplexId first = rep.first_simplex(f);
      return std::pair{first, SimplexId(first + Mesh::simplices_of(rep.face(f).size(), rep.dim()))};
    };
    const auto [a_begin, a_end] = range(ctx_[Side::a].rep(), fa);
    const auto [b_begin, b_end] = range(ctx_[Side::b].rep(), fb);
    for (SimplexId a = a_begin; a < a_end; ++a)
      for (SimplexId b = b_begin; b < b_end; ++b)
        if (visit(a, b)) return;
  }

  QueryContext& ctx_;
  const CollideRequest& request_;
  CollideResult& result_;
  Probe& probe_;
  bool done_ = false;
};

}  // namespace lrb
