/// Which regions are bad, and what helps; the faults of a mesh that are marked. The commands:
/// tests/commands/regions.txt, inspect.txt.

#include <numeric>
#include <set>

#include <doctest/doctest.h>

#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

using bodies::RegionFigures;
using bodies::RegionOrder;

}  // namespace

TEST_CASE("figures of regions add up to the body's") {
  for (const Mesh& mesh : {bowl(24, 8), comb(4), gear(12)}) {
    const LrbRep rep = build_lrb(mesh);
    std::vector<FaceId> real(rep.real_face_count());
    std::iota(real.begin(), real.end(), FaceId{0});
    const double outer = enclosed_volume(rep, rep.outermost_faces());
    const std::vector<double> thickness = region_thickness(rep);
    for (const RegionOrder order :
         {RegionOrder::waste, RegionOrder::thickness, RegionOrder::volume, RegionOrder::lids}) {
      const std::vector<RegionFigures> regions = bodies::region_figures(rep, order, 1);
      REQUIRE(regions.size() == rep.region_count());
      double volume = 0;
      std::set<RegionId> seen;
      for (std::size_t i = 0; i < regions.size(); ++i) {
        const RegionFigures& r = regions[i];
        seen.insert(r.region);
        volume += r.volume;
        CHECK(r.lids == rep.lids(r.region).size());
        CHECK(r.thickness == thickness[r.region]);
        CHECK(r.parent == rep.parent(r.region));
        CHECK(r.waste == doctest::Approx(r.floor * r.volume / outer));
        if (i == 0) continue;
        const RegionFigures& before = regions[i - 1];
        if (order == RegionOrder::waste) CHECK(before.waste >= r.waste);
        if (order == RegionOrder::thickness) CHECK(before.thickness >= r.thickness);
        if (order == RegionOrder::volume) CHECK(before.volume >= r.volume);
        if (order == RegionOrder::lids) CHECK(before.lids >= r.lids);
      }
      CHECK(seen.size() == regions.size());
      CHECK(volume == doctest::Approx(outer - enclosed_volume(rep, real)));
      const std::vector<double> shares = bodies::waste_over_faces(rep, regions);
      std::set<RegionId> above;  // some real face, along parents
      for (const FaceId f : real)
        for (CellId c = rep.outer_cell(f); is_region(c); c = rep.parent(c.as_region()))
          above.insert(c.as_region());
      double beneath = 0;
      for (const RegionFigures& r : regions)
        if (above.contains(r.region)) beneath += r.waste;
      CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == doctest::Approx(beneath));
      CHECK(beneath <= doctest::Approx(bodies::total_waste(regions)));
      CHECK(beneath > 0.9 * bodies::total_waste(regions));
    }
  }
}

TEST_CASE("only settings with better numbers are advised") {
  const LrbRep disc = build_lrb(scaled(icosphere(2), 0.5));
  const std::vector<bodies::Trial> worse = {{"", {1.5, 20, 1.2, 3, 0}}, {"--patch 8", {1.6, 20, 1.3, 4, 1}}};
  CHECK(bodies::advice(disc, worse) == std::vector<std::string>{"no setting tried is more than 5 % better"});
  const std::vector<bodies::Trial> better = {{"", {1.59, 20, 1.2, 3, 0}},
                                             {"--patch 40", {1.42, 20, 1.2, 2, 1}}};
  REQUIRE(bodies::advice(disc, better).size() == 2);
  CHECK(
      bodies::advice(disc, better)[0] ==
      "--patch 40 has the lowest waste: 2 instead of 3 faces per point, with 1.42 instead of 1.59 faces per real face");
}

TEST_CASE("faults with the same elements are drawn once") {
  const Mesh doubled = with_doubled(icosphere(1), {3, 9});  // they also meet
  CHECK(render::findings::kinds(check_mesh(doubled)) ==
        std::vector{MeshFault::duplicate_face, MeshFault::non_manifold_edge});
  const Mesh collapsed = with_face(icosphere(1), {}, {0, 0, 1});
  CHECK(render::findings::kinds(check_mesh(collapsed)) == std::vector{MeshFault::zero_area_face});
  CHECK(render::findings::kinds(check_mesh(icosphere(1))).empty());
}

}  // namespace lrb::test
