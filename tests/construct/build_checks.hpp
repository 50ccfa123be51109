#pragma once
/// Checks of every built LRB-rep, independent of the builders' code.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::test {

/// The regions whose faces are all in one plane.
inline std::vector<bool> flat_regions(const LrbRep& rep) {
  std::vector<bool> flat(rep.region_count(), rep.dim() == 3);
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    std::vector<const double*> points;
    for (const FaceId f : rep.collector(r))
      for (const VertexId v : rep.face(f)) points.push_back(rep.vertices()[v].data());
    std::size_t i = 2;
    while (i < points.size() && exact::collinear3d(points[0], points[1], points[i])) ++i;
    for (const double* p : points)
      flat[r] = flat[r] && i < points.size() && exact::orient3d(points[0], points[1], points[i], p) == 0;
  }
  return flat;
}

/// Pairs of simplices, at least one of them of a pseudo face, that meet in more than they share: all against
/// all, but for floors of flat regions, which are parts of their lids, and lids that are a part of a merged
/// plane.
inline std::uint64_t bad_pairs_by_brute_force(const LrbRep& rep) {
  std::uint64_t bad = 0;
  const std::vector<bool> flat = flat_regions(rep);
  for (SimplexId s = 0; s < rep.simplex_count(); ++s) {
    for (SimplexId t(std::max(s + 1, rep.real_simplex_count())); t < rep.simplex_count(); ++t) {
      const CellId between = rep.outer_cell(rep.face_of_simplex(s));
      if (is_region(between) && flat[between]) continue;
      VertexId a[3], b[3];
      rep.simplex(s, a);
      rep.simplex(t, b);
      const FaceId plane = rep.face_of_simplex(s), lid = rep.face_of_simplex(t);
      if (rep.inner_cell(lid) == between && !rep.is_real(plane) && rep.face(plane).size() > 3 &&
          std::is_permutation(a, a + 3, b))
        continue;
      const double *pa[3], *pb[3];
      for (int i = 0; i < rep.simplex_size(); ++i) {
        pa[i] = rep.vertices()[a[i]].data();
        pb[i] = rep.vertices()[b[i]].data();
      }
      bad += rep.dim() == 3 ? !exact::meet_only_in_shared(pa, a, pb, b)
                            : !exact::meet_only_in_shared_2d(pa, a, pb, b);
    }
  }
  return bad;
}

inline void check_valid(const LrbRep& rep, std::uint32_t states = 20) {
  ValidateOptions options;
  options.wrapper_states = states;
  const ValidateReport report = validate(rep, options);
  CAPTURE(rep.name());
  const std::string first_violation = report.violations.empty() ? "" : report.violations.front();
  CAPTURE(first_violation);
  CHECK(report.valid);
  // The builders put every other lid strictly in front.
  const std::vector<bool> flat = flat_regions(rep);
  CHECK((report.flat_pairs > 0) == (std::count(flat.begin(), flat.end(), true) > 0));
}

/// The faces of the mesh come first, as they were.
inline void check_keeps_mesh(const LrbRep& rep, const Mesh& mesh) {
  REQUIRE(rep.real_face_count() == mesh.face_count());
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto a = rep.face(f), b = mesh.face(f);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(a[i] == b[i]);
    REQUIRE(rep.inner_cell(f) == kSolid);
  }
  Wrapper w(rep);
  w.refine_all();
  const std::vector<FaceId> all = w.boundary();
  CHECK(all.size() == mesh.face_count());
  CHECK((all.empty() || all.back() + 1 == mesh.face_count()));
}

}  // namespace lrb::test
