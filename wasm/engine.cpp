// The engine's interface for JavaScript: two bodies, queried for all intersecting pairs at any pose of B.
// Bodies are given as the bytes of .lrb files, so that they are the ones that were built natively: the
// answers are then the same as native ones, bit for bit.
//
// Results are views into this program's memory, valid until the next query.

#include <chrono>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <emscripten/emscripten.h>

#include "engine/collide/collide_into.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/observe.hpp>

namespace {

using lrb::Side;

/// Collects the faces that a query tests, each once.
class TestedFaces : public lrb::CollideProbe {
 public:
  TestedFaces(const lrb::LrbRep& a, const lrb::LrbRep& b) : reps_{&a, &b} {
    for (int side = 0; side < 2; ++side) seen_[side].resize(reps_[side]->face_count());
  }

  void face_test(lrb::SimplexId a, lrb::SimplexId b, lrb::exact::Meet, std::uint32_t,
                 std::uint32_t) override {
    add(0, reps_[0]->face_of_simplex(a));
    add(1, reps_[1]->face_of_simplex(b));
  }

  std::vector<std::uint32_t> faces[2];

 private:
  void add(int side, lrb::FaceId face) {
    if (seen_[side][face.value()]) return;
    seen_[side][face.value()] = true;
    faces[side].push_back(face.value());
  }

  const lrb::LrbRep* reps_[2];
  std::vector<bool> seen_[2];
};

/// Two bodies, the answer of the last query, and the memory that queries reuse.
struct Session {
  void query(lrb::CollideProbe* probe = nullptr) {
    lrb::clear(result);
    lrb::collide_watched(*reps[0], poses[0], *reps[1], poses[1], {}, context, probe, result);
  }

  std::optional<lrb::LrbRep> reps[2];
  lrb::Pose poses[2];
  lrb::QueryContext context;
  lrb::CollideResult result;
  std::vector<std::uint32_t> lists[6];
  std::string text;
};

Session& session() {
  static Session s;
  return s;
}

/// Runs the query again until it has taken `seconds`, because a browser's clock has steps of 0.1 ms. Returns
/// the mean time of a query in microseconds.
double micros_of(Session& s, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const auto spent = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  constexpr int kMaxRuns = 200;
  int runs = 0;
  do {
    s.query();
    ++runs;
  } while (spent() < seconds && runs < kMaxRuns);
  return 1e6 * spent() / runs;
}

/// Queries once more, with a probe, and fills the lists. The answer is the same with and without a probe.
void take_lists(Session& s) {
  TestedFaces tested(*s.reps[0], *s.reps[1]);
  s.query(&tested);
  for (std::vector<std::uint32_t>& list : s.lists) list.clear();
  for (const lrb::SimplexPair& pair : s.result.pairs) {
    s.lists[0].push_back(pair.a.value());
    s.lists[1].push_back(pair.b.value());
  }
  for (int side = 0; side < 2; ++side)
    for (const lrb::RegionId region : s.result.opened[side]) s.lists[2 + side].push_back(region.value());
  for (int side = 0; side < 2; ++side) s.lists[4 + side] = std::move(tested.faces[side]);
}

}  // namespace

extern "C" {

/// Loads the body `side` (0: A, 1: B) from the bytes of a .lrb file.
EMSCRIPTEN_KEEPALIVE void lrb_load(int side, const char* bytes, std::size_t size) {
  session().reps[side].emplace(lrb::load_lrb(std::string_view(bytes, size), side == 0 ? "A" : "B"));
}

/// Sets the pose of a body: 12 numbers, the rows of [R | t].
EMSCRIPTEN_KEEPALIVE void lrb_pose(int side, const double* rows) {
  session().poses[side] = lrb::pose_of_rows({rows, 12}).value();
}

/// Queries all pairs, for `seconds` of repetitions (0: once). Returns the mean time in microseconds.
EMSCRIPTEN_KEEPALIVE double lrb_query(double seconds) {
  Session& s = session();
  const double micros = micros_of(s, seconds);
  take_lists(s);
  return micros;
}

/// Return a word of the answer: 0: the relation, 1: the fingerprint in hexadecimal digits.
EMSCRIPTEN_KEEPALIVE const char* lrb_word(int which) {
  Session& s = session();
  if (which == 0) {
    s.text = lrb::to_string(s.result.relation);
  } else {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016" PRIx64, lrb::fingerprint(s.result.pairs));
    s.text = digits;
  }
  return s.text.c_str();
}

/// Return a list of the answer: 0, 1: the pairs' simplices of A and of B; 2, 3: refined regions of A and of
/// B; 4, 5: tested faces of A and of B.
EMSCRIPTEN_KEEPALIVE const std::uint32_t* lrb_list(int which) {
  return session().lists[which].data();
}
EMSCRIPTEN_KEEPALIVE std::size_t lrb_list_size(int which) {
  return session().lists[which].size();
}

/// Returns a counter of the query: 0: face tests, 1: pairs of nodes, 2: box tests, 3: regions refined, 4:
/// exact fallbacks.
EMSCRIPTEN_KEEPALIVE double lrb_counter(int which) {
  const lrb::Counters& c = session().result.counters;
  const std::uint64_t counters[] = {c.face_tests, c.node_pairs, c.box_tests, c.regions_opened,
                                    c.exact_fallbacks};
  return static_cast<double>(counters[which]);
}

}  // extern "C"
