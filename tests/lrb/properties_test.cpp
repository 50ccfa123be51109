// A wrapper, however refined, contains the body: exactly, for random sets of regions.

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "engine/exact/locate.hpp"
#include "engine/lrb/complex.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/rational_oracle.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/wrapper.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

std::vector<LrbRep> built() {
  std::vector<LrbRep> list;
  list.push_back(shapes::dented_box());
  list.push_back(shapes::stairs_2d());
  for (const Mesh& m :
       {shapes::bumpy_sphere(2, 4, 0.5), shapes::torus(12, 8), shapes::comb(4), shapes::bowl(10, 4)})
    list.push_back(build_lrb(m));
  list.push_back(build_lrb(shapes::gear(12)));
  return list;
}

bool is_closed(const Wrapper& w) {
  BoundarySum sum(w.rep());
  for (const FaceId f : w.boundary()) {
    // A face of an included region under an excluded one shows its other side.
    if (w.included(w.rep().inner_cell(f)))
      sum.add(f);
    else
      sum.add_reversed(f);
  }
  VertexId at[2];
  return sum.take_closed(at);
}

/// A point of the solid's boundary is in the wrapper or on it, exactly.
bool holds(const Wrapper& w, const Eigen::Vector3d& p) {
  const LrbRep& rep = w.rep();
  int crossings = 0;
  for (const FaceId f : w.boundary()) {
    const SimplexId first = rep.first_simplex(f);
    const std::size_t count = Mesh::simplices_of(rep.face(f).size(), rep.dim());
    for (SimplexId s = first; s < first + count; ++s) {
      VertexId v[3];
      rep.simplex(s, v);
      const double* c[3];
      for (int k = 0; k < rep.dim(); ++k) c[k] = rep.vertices()[v[k]].data();
      const exact::RayHit hit =
          rep.dim() == 3 ? exact::ray_crosses(p.data(), c) : exact::ray_crosses_2d(p.data(), c);
      if (hit == exact::RayHit::on_face) return true;
      crossings += hit == exact::RayHit::crosses;
    }
  }
  return crossings % 2 != 0;
}

}  // namespace

TEST_CASE("refining and then coarsening is the identity") {
  RandomEngine random(3);
  for (const LrbRep& rep : built())
    for (const WrapperMode mode : {WrapperMode::regularised, WrapperMode::unregularised}) {
      Wrapper w(rep, mode);
      const std::vector<FaceId> outermost = w.boundary();
      std::vector<RegionId> open;
      for (int i = 0; i < 200 && rep.region_count() > 0; ++i) {
        const std::vector<FaceId> before = w.boundary();
        const auto r = static_cast<RegionId>(random() % rep.region_count());
        if (!w.refine(r)) continue;
        const std::vector<FaceId> refined = w.boundary();
        REQUIRE(w.coarsen(r));
        REQUIRE(w.boundary() == before);
        REQUIRE(w.refine(r));
        REQUIRE(w.boundary() == refined);
        open.push_back(r);
      }
      for (const RegionId r : open) REQUIRE(w.coarsen(r));
      CHECK(w.boundary() == outermost);
      w.refine_all();
      const std::vector<FaceId> real = w.boundary();
      REQUIRE(real.size() == rep.real_face_count());
      for (FaceId f = 0; f < real.size(); ++f) REQUIRE(real[f] == f);
      w.reset();
      CHECK(w.boundary() == outermost);
    }
}

namespace {

struct Simplices {
  std::vector<std::array<const double*, 3>> corners;
  std::vector<Eigen::AlignedBox3d> boxes;

  void add(const LrbRep& rep, FaceId f) {
    const SimplexId first = rep.first_simplex(f);
    const std::size_t count = Mesh::simplices_of(rep.face(f).size(), rep.dim());
    for (SimplexId s = first; s < first + count; ++s) {
      VertexId v[3];
      rep.simplex(s, v);
      corners.emplace_back();
      boxes.emplace_back();
      for (int k = 0; k < rep.dim(); ++k) {
        corners.back()[k] = rep.vertices()[v[k]].data();
        boxes.back().extend(rep.vertices()[v[k]]);
      }
    }
  }
};

/// No real face passes through a lid of the wrapper, by the rational oracle: with all real vertices in or on
/// the wrapper, the whole of the solid's surface is.
std::uint64_t lids_crossed(const Wrapper& w, const Simplices& real) {
  const LrbRep& rep = w.rep();
  Simplices lids;
  for (const FaceId f : w.boundary())
    if (!rep.is_real(f)) lids.add(rep, f);
  std::uint64_t crossed = 0;
  for (std::size_t i = 0; i < lids.boxes.size(); ++i)
    for (std::size_t j = 0; j < real.boxes.size(); ++j)
      if (lids.boxes[i].intersects(real.boxes[j]))
        crossed += oracle::meet_of_simplices(lids.corners[i].data(), real.corners[j].data(),
                                             static_cast<std::size_t>(rep.dim())) == 2;
  return crossed;
}

std::uint64_t vertices_outside(const Wrapper& w) {
  std::vector<bool> checked(w.rep().vertices().size(), false);
  std::uint64_t outside = 0;
  for (FaceId f = 0; f < w.rep().real_face_count(); ++f)
    for (const VertexId v : w.rep().face(f)) {
      if (checked[v]) continue;
      checked[v] = true;
      outside += !holds(w, w.rep().vertices()[v]);
    }
  return outside;
}

void check_lids(std::uint32_t every) {
  RandomEngine random(5);
  for (const LrbRep& rep : built()) {
    CAPTURE(rep.name());
    Simplices real;
    for (FaceId f = 0; f < rep.real_face_count(); ++f) real.add(rep, f);
    Wrapper w(rep);
    const auto check = [&] {
      REQUIRE(is_closed(w));
      REQUIRE(vertices_outside(w) == 0);
      REQUIRE(lids_crossed(w, real) == 0);
    };
    check();
    w.refine_all();
    for (RegionId r = 0; r < rep.region_count(); ++r) {
      if (r % every != 0) continue;
      CAPTURE(r);
      REQUIRE(w.coarsen(r));
      check();
      REQUIRE(w.refine(r));
    }
    for (int i = 0; i < 5; ++i) {
      w.reset();
      for (RegionId r = 0; r < rep.region_count(); ++r)
        if (random() % 2) w.refine(r);
      check();
    }
  }
}

}  // namespace

TEST_CASE("lids of single regions and of sets of regions enclose the solid exactly") {
  check_lids(4);
}

TEST_CASE("lids of all single regions enclose the solid exactly" * doctest::test_suite("long")) {
  check_lids(1);
}
