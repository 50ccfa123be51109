/// Attempts of a builder by region, and regions of two builds matched by place, against plain definitions.
#include "scenarios/record/attempts.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <set>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "scenarios/compare/compare.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/trace/counters.hpp>

using namespace lrb;
using trace::runs::Built;

namespace {

Built build_recorded(const Mesh& mesh, std::uint32_t patch) {
  BuildOptions options;
  options.patch_interior = patch;
  return trace::runs::build(mesh, options);
}

std::vector<Mesh> bodies_to_build() {
  return {shapes::bumpy_sphere(3, 7, 0.3), shapes::quad_torus(20, 10), shapes::ring_2d(60)};
}

std::set<std::uint32_t> vertices_of(const LrbRep& rep, std::span<const FaceId> faces) {
  std::set<std::uint32_t> out;
  for (const FaceId f : faces)
    for (const VertexId v : rep.face(f)) out.insert(v);
  return out;
}

using Faces = std::set<std::uint32_t>;

/// Returns the real faces below each region: those from which parents lead to it, or if there are none, those
/// below the regions that it touches.
std::vector<Faces> faces_below(const LrbRep& rep) {
  std::vector<Faces> out(rep.region_count());
  for (FaceId f(0); f < rep.real_face_count(); ++f)
    for (CellId c = rep.outer_cell(f); is_region(c); c = rep.parent(c.as_region()))
      out[c.as_region()].insert(f);
  const std::vector<Faces> along = out;
  const std::function<Faces(RegionId)> find = [&](RegionId r) {
    Faces found = along[r];
    if (!found.empty()) return found;
    for (const FaceId f : rep.floor(r))
      if (const CellId c = rep.inner_cell(f); is_region(c)) found.merge(find(c.as_region()));
    return found;
  };
  for (RegionId r(0); r < rep.region_count(); ++r) out[r] = find(r);
  return out;
}

double overlap(const Faces& x, const Faces& y) {
  std::vector<std::uint32_t> common;
  std::set_intersection(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(common));
  return static_cast<double>(common.size()) / static_cast<double>(x.size() + y.size() - common.size());
}

}  // namespace

TEST_CASE("attempts by region: those that could have covered what it covers, and its own last") {
  for (const Mesh& mesh : bodies_to_build()) {
    CAPTURE(mesh.name);
    const Built built = build_recorded(mesh, 12);
    const std::vector<record::Attempt> attempts = record::attempts_of(built.trace);
    REQUIRE(attempts.size() > 20);
    const auto of_region = record::attempts_by_region(built.trace, built.rep, attempts);
    REQUIRE(of_region.size() == built.rep.region_count());
    std::size_t rejected = 0, accepted = 0;
    for (const record::Attempt& a : attempts) (a.rejected() ? rejected : accepted) += 1;
    std::size_t caps = 0;
    for (const auto& pass : trace::passes_of(built.trace)) caps += pass.caps[0];
    CHECK(accepted == caps);
    CHECK(rejected > 0);
    for (RegionId r(0); r < built.rep.region_count(); ++r) {
      const auto kept = vertices_of(built.rep, built.rep.lids(r));
      std::set<std::uint32_t> covered = vertices_of(built.rep, built.rep.floor(r));
      for (const std::uint32_t v : kept) covered.erase(v);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < attempts.size(); ++i) {
        const record::Attempt& a = attempts[i];
        const bool whole = built.trace.events[a.patch].patch().interior == 0;
        bool there = std::count(a.regions.begin(), a.regions.end(), r) > 0;
        for (const VertexId v : a.vertices) there = there || covered.contains(v);
        if (a.vertices.empty() && !whole) there = there || covered.contains(a.vertex);
        if (there) expected.push_back(i);
      }
      CHECK(of_region[r] == expected);
      // Nothing is tried at a place after it was covered, except that in 2D chains whose part is covered are
      // rejected.
      bool made = false;
      for (const std::uint32_t i : of_region[r]) {
        if (made) CHECK((attempts[i].vertices.empty() && attempts[i].verdict == CapVerdict::overlaps));
        made = made || std::count(attempts[i].regions.begin(), attempts[i].regions.end(), r) > 0;
      }
    }
  }
}

TEST_CASE("regions of two builds are matched by the real faces below them") {
  for (const Mesh& mesh : bodies_to_build()) {
    CAPTURE(mesh.name);
    const Built few = build_recorded(mesh, 8), many = build_recorded(mesh, 40);
    REQUIRE(compare::same_real_faces(few.rep, many.rep));
    const compare::RegionMatching m = compare::match_regions(few.rep, many.rep);
    CHECK(m.pairs.size() + m.unmatched[0].size() == few.rep.region_count());
    CHECK(m.pairs.size() + m.unmatched[1].size() == many.rep.region_count());
    CHECK_FALSE(m.pairs.empty());
    const std::vector<Faces> below_few = faces_below(few.rep), below_many = faces_below(many.rep);
    std::set<std::uint32_t> left, right;
    for (const compare::MatchedRegions& p : m.pairs) {
      CHECK(left.insert(p.of[0]).second);
      CHECK(right.insert(p.of[1]).second);
      const Faces &x = below_few[p.of[0]], &y = below_many[p.of[1]];
      CHECK(p.overlap() == doctest::Approx(overlap(x, y)));
      CHECK(p.overlap() >= compare::kSamePlace);
      CHECK(p.below ==
            std::array{static_cast<std::uint32_t>(x.size()), static_cast<std::uint32_t>(y.size())});
    }
    // No two regions without a partner are at the same place.
    for (const RegionId p : m.unmatched[0])
      for (const RegionId q : m.unmatched[1])
        CHECK_FALSE(overlap(below_few[p], below_many[q]) >= compare::kSamePlace);
  }
}
