#pragma once
/// Checks of every built LRB-rep, independent of the builders' code.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <lrbscope/build.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::test {

/// Pairs of simplices, at least one of them of a pseudo face, that meet in more than they share: all against
/// all.
inline std::uint64_t bad_pairs_by_brute_force(const LrbRep& rep) {
  std::uint64_t bad = 0;
  for (SimplexId s = 0; s < rep.simplex_count(); ++s) {
    for (SimplexId t(std::max(s + 1, rep.real_simplex_count())); t < rep.simplex_count(); ++t) {
      VertexId a[3], b[3];
      rep.simplex(s, a);
      rep.simplex(t, b);
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
  CHECK(report.flat_pairs == 0);  // the builders put every lid strictly in front
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
