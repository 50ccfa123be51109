// A builder's reports to its probe add up to the body that it built, on any number of threads, and change
// nothing.

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

struct Reported {
  enum class Kind : std::uint8_t { pass, patch, cap, region, merged, end_pass, closed } kind;
  PassStart start = {};
  PassEnd end = {};
  GrownPatch patch = {};
  TriedCap cap = {};
  std::uint32_t number = 0, pieces = 0;

  /// All reported values as text, to compare.
  std::string to_text() const {
    const std::array<double, 18> all = {static_cast<double>(kind),
                                        static_cast<double>(start.stage),
                                        double(start.layer),
                                        double(start.front_faces),
                                        start.max_deviation,
                                        double(end.front_faces),
                                        double(end.excluded),
                                        double(end.no_patch),
                                        double(end.waiting),
                                        double(end.given_up),
                                        double(patch.vertex),
                                        double(patch.faces),
                                        double(patch.interior),
                                        double(cap.faces),
                                        double(cap.covered),
                                        static_cast<double>(cap.verdict) + (cap.careful ? 0.5 : 0),
                                        cap.off,
                                        number + pieces / 1e6};
    std::string out;
    for (const double x : all) out += std::to_string(x) + " ";
    return out;
  }
};

struct Listener final : ConstructProbe {
  std::vector<Reported> reported;
  void pass(const PassStart& p) override { reported.push_back({.kind = Reported::Kind::pass, .start = p}); }
  void patch(const GrownPatch& p) override {
    reported.push_back({.kind = Reported::Kind::patch, .patch = p});
  }
  void cap(const TriedCap& c) override { reported.push_back({.kind = Reported::Kind::cap, .cap = c}); }
  void region(RegionId r) override { reported.push_back({.kind = Reported::Kind::region, .number = r}); }
  void merged(RegionId into, std::uint32_t pieces) override {
    reported.push_back({.kind = Reported::Kind::merged, .number = into, .pieces = pieces});
  }
  void end_pass(const PassEnd& e) override {
    reported.push_back({.kind = Reported::Kind::end_pass, .end = e});
  }
  void closed(std::uint32_t faces) override {
    reported.push_back({.kind = Reported::Kind::closed, .number = faces});
  }
};

LrbRep build_reported(const Mesh& mesh, Listener& listener, unsigned threads = 1, bool lean = false) {
  BuildOptions options;
  options.threads = threads;
  options.lean = lean;
  options.probe = &listener;
  return build_lrb(mesh, options);
}

/// So small that a patch is a ball as a whole: then the ball's surface is an inner shell of its region.
Mesh many_balls() {
  std::vector<Mesh> balls;
  for (int i = 0; i < 40; ++i) balls.push_back(translated(icosphere(0), {3.0 * (i % 7), 3.0 * (i / 7), 0}));
  return several(balls);
}

/// Bodies of one component and of several, crossing, nested, with voids, of polygons and in the plane.
std::vector<Mesh> bodies() {
  return {bumpy_sphere(4, 3),
          comb(12),
          quad_torus(40, 20),
          bowl(40, 20),
          several({bumpy_sphere(3, 5), translated(bumpy_sphere(3, 6), {0.9, 0.1, 0.2}),
                   translated(icosphere(3), {4, 0, 0}),
                   translated(turned_inside_out(icosphere(2, 0.5)), {4, 0, 0})}),
          several({icosphere(4), turned_inside_out(icosphere(4, 1.02)), icosphere(3, 1.5)}),
          many_balls(),
          gear(100),
          comb_2d(20),
          ring_2d(60),
          several({circle(40, 3), turned_inside_out(circle(30, 2)), star(5)}),
          several({star(5), translated(star(7), {3, 0, 0}), translated(gear(30), {0, 3, 0})})};
}

std::size_t segments_or_triangles(const Mesh& mesh) {
  std::size_t count = 0;
  for (FaceId f = 0; f < mesh.face_count(); ++f) count += mesh.dim == 2 ? 1 : mesh.face(f).size() - 2;
  return count;
}

/// Follows the reports on one body, and checks that each one follows from the previous ones.
/// Returns the number of pieces that were merged.
std::size_t check_story(const std::vector<Reported>& reported, const LrbRep& rep, std::size_t mesh_faces) {
  std::uint32_t regions = 0, front = static_cast<std::uint32_t>(mesh_faces), lids = 0;
  bool open = false;
  PassStart pass;
  TriedCap last;
  std::size_t merged = 0;
  for (const Reported& t : reported) {
    switch (t.kind) {
      case Reported::Kind::pass:
        CHECK_FALSE(open);
        open = true;
        pass = t.start;
        CHECK(pass.front_faces == front);
        last = {};
        break;
      case Reported::Kind::patch:
        CHECK(open);
        CHECK(t.patch.faces > 0);
        CHECK(t.patch.vertex < rep.vertices().size());
        break;
      case Reported::Kind::cap:
        last = t.cap;
        if (last.off >= 0) CHECK(last.off <= pass.max_deviation);
        if (last.verdict != CapVerdict::accepted) break;
        lids += last.faces;
        if (pass.stage == BuildStage::close)
          front = last.faces;
        else
          front = front + last.faces - last.covered;
        break;
      case Reported::Kind::region:
        CHECK(last.verdict == CapVerdict::accepted);
        CHECK(t.number == regions++);
        REQUIRE(t.number < rep.region_count());
        CHECK(rep.layer(RegionId(t.number)) == pass.layer);
        break;
      case Reported::Kind::merged:
        CHECK(t.number < regions);
        merged += t.pieces;
        break;
      case Reported::Kind::end_pass:
        CHECK(open);
        open = false;
        if (pass.stage == BuildStage::fill) front = t.end.front_faces;  // walls of voids are no longer hull
        CHECK(t.end.front_faces == front);
        break;
      case Reported::Kind::closed:
        CHECK(&t == &reported.back());
        CHECK(t.number == front);
        CHECK(t.number == rep.outermost_faces().size());
        break;
    }
  }
  REQUIRE_FALSE(reported.empty());
  CHECK(reported.back().kind == Reported::Kind::closed);
  CHECK(regions == rep.region_count());
  CHECK(lids == rep.face_count() - rep.real_face_count());
  return merged;
}

std::vector<std::string> to_text(const std::vector<Reported>& reported) {
  std::vector<std::string> out;
  for (const Reported& t : reported) out.push_back(t.to_text());
  return out;
}

std::size_t count(const std::vector<Reported>& reported, CapVerdict verdict) {
  std::size_t n = 0;
  for (const Reported& t : reported) n += t.kind == Reported::Kind::cap && t.cap.verdict == verdict;
  return n;
}

TEST_CASE(
    "reports to the probe add up to the body and do not depend on 1, 2 or 4 threads; the body is the same without a probe" *
    doctest::test_suite("long")) {
  std::array<std::size_t, kEnumNames<CapVerdict>.size()> verdicts{};
  std::size_t merged = 0;
  for (const Mesh& mesh : bodies()) {
    CAPTURE(mesh.name);
    CAPTURE(mesh.face_count());
    Listener one;
    const LrbRep rep = build_reported(mesh, one);
    CHECK(rep.hash() == build_lrb(mesh).hash());
    merged += check_story(one.reported, rep, segments_or_triangles(mesh));
    for (std::size_t v = 0; v < verdicts.size(); ++v)
      verdicts[v] += count(one.reported, static_cast<CapVerdict>(v));
    for (const unsigned threads : {2u, 4u}) {
      Listener many;
      CHECK(build_reported(mesh, many, threads).hash() == rep.hash());
      CHECK((to_text(many.reported) == to_text(one.reported)));
    }
  }
  CHECK(merged > 0);
  using enum CapVerdict;
  for (const CapVerdict v : {accepted, too_thick, too_much_volume, too_many_faces, no_place, meets_front,
                             overlaps, several_outlines})
    CHECK_MESSAGE(verdicts[static_cast<std::size_t>(v)] > 0, name_of(v));
}

TEST_CASE("reports to the probe add up for lean bodies and patches of any size") {
  for (const Mesh& mesh : {bumpy_sphere(4, 7), comb(12), gear(60)}) {
    Listener listener;
    const LrbRep rep = build_reported(mesh, listener, 1, true);
    check_story(listener.reported, rep, segments_or_triangles(mesh));
    for (const Reported& t : listener.reported)
      if (t.kind == Reported::Kind::pass) CHECK(t.start.stage != BuildStage::fit);
  }
}

TEST_CASE(
    "in a thin gap caps are rejected because they intersect the front; intersecting faces are excluded") {
  Listener gap;
  const Mesh nested = several({icosphere(4), turned_inside_out(icosphere(4, 1.003)), icosphere(3, 1.5)});
  build_reported(nested, gap);
  CHECK(count(gap.reported, CapVerdict::meets_front) > 0);

  Listener crossing;
  build_reported(several({bumpy_sphere(3, 5), translated(bumpy_sphere(3, 6), {0.9, 0.1, 0.2})}), crossing);
  std::uint32_t excluded = 0;
  for (const Reported& t : crossing.reported) excluded = std::max(excluded, t.end.excluded);
  CHECK(excluded > 0);
}

TEST_CASE("an exception from a probe ends the build") {
  struct Thrower final : ConstructProbe {
    void region(RegionId) override { throw InputError("enough"); }
  } thrower;
  BuildOptions options;
  options.probe = &thrower;
  CHECK_THROWS_WITH_AS(build_lrb(bumpy_sphere(3, 3), options), "enough", InputError);
}

}  // namespace
}  // namespace lrb::test
