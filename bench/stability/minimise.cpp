#include "bench/stability/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string>
#include <unordered_set>

#include "bench/methods/triangles.hpp"
#include "bench/stability/case_picture.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::stability {
namespace {

using Eigen::Vector3d;
using methods::part_of;

bool crosses(const cases::Case& c, const SimplexPair& pair) {
  return PosedPair(c, pair).contact().meet == exact::Meet::cross;
}

/// Returns the wrong pairs of an answer, the worst kind first. Without a list, a wrong "no contact" misses
/// all pairs.
Pairs wrong_pairs(const cases::Case& c, const Replay& answer) {
  const Verdict verdict = compare(answer.expected, answer.answered);
  Pairs missed = verdict.missed;
  if (!answer.answered && answer.record.missed > 0) missed = answer.expected;
  std::stable_partition(missed.begin(), missed.end(), [&](const SimplexPair& p) { return crosses(c, p); });
  missed.insert(missed.end(), verdict.extra.begin(), verdict.extra.end());
  return missed;
}

// ---- Meshes

/// Returns the mesh with the simplices of the faces as faces, in their order.
Mesh simplices_of(const Mesh& mesh) {
  Mesh out = mesh;
  if (mesh.dim == 2) return out;
  out.face_offsets = {0};
  out.face_vertices.clear();
  std::vector<std::array<VertexId, 3>> triangles;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    cut_polygon(mesh, f, triangles);
    for (const auto& t : triangles) out.add_face(t);
  }
  return out;
}

bool has_repeated_corner(std::span<const VertexId> corners) {
  return std::set<VertexId>(corners.begin(), corners.end()).size() < corners.size();
}

/// Returns the mesh with vertex `from` replaced by `to`, and without the faces that this collapses.
Mesh merged(Mesh mesh, VertexId from, VertexId to) {
  std::replace(mesh.face_vertices.begin(), mesh.face_vertices.end(), from, to);
  return part_of(mesh, [&](FaceId f) { return !has_repeated_corner(mesh.face(f)); });
}

/// Returns true if the pose is a rotation of the grid: a permutation of axes with signs.
bool turns_grid(const Pose& pose) {
  return (pose.r.cwiseAbs().array() == 0 || pose.r.cwiseAbs().array() == 1).all();
}

/// Returns the number of faces without area (2D: length) in the world.
std::uint64_t degenerate_faces(const CaseMeshes& c) {
  std::uint64_t n = 0;
  for (const Mesh& m : {methods::at_pose(c.a, c.pose_a), methods::at_pose(c.b, c.pose_b)})
    n += check_mesh(m, false)[MeshFault::zero_area_face].count;
  return n;
}

// ---- Numbers

/// Returns x rounded to a number of significant bits; `step`: number of units further up (away from 0) or
/// down.
double rounded_to_bits(double x, int bits, int step) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(fraction, bits)) + step * (x < 0 ? -1 : 1), exponent - bits);
}

int significand_bits(double x) {
  if (x == 0) return 0;
  int exponent = 0;
  auto m = static_cast<std::uint64_t>(std::ldexp(std::abs(std::frexp(x, &exponent)), 53));
  int bits = 53;
  for (; (m & 1) == 0; m >>= 1) --bits;
  return bits;
}

/// Returns numbers with fewer bits that may replace x, in ascending order of their bits: small ones, x
/// rounded, x closer to 1 by a power of two, and other numbers of the case.
std::vector<double> replacements(double x, const std::set<double>& others) {
  std::vector<double> out = {0, 1, -1, 2, -2, 3, -3, 0.5, -0.5};
  out.push_back(std::nearbyint(x));
  const int most = significand_bits(x);
  for (int bits = 1; bits < most; ++bits)
    for (const int step : {0, -1, 1})
      if (step == 0 || bits < 5) out.push_back(rounded_to_bits(x, bits, step));
  const int exponent = std::ilogb(x == 0 ? 1 : x);
  for (int shift = 1; shift <= std::abs(exponent); shift *= 2) {
    const double y = std::ldexp(x, exponent > 0 ? -shift : shift);
    out.insert(out.end(), {y, rounded_to_bits(y, 1, 0), rounded_to_bits(y, 2, 0), std::nearbyint(y)});
  }
  for (const double y : others) out.push_back(y);
  std::erase_if(out, [&](double y) { return !std::isfinite(y) || bits_of(y) >= bits_of(x); });
  std::stable_sort(out.begin(), out.end(), [&](double y, double z) {
    return std::pair(bits_of(y), std::abs(y - x)) < std::pair(bits_of(z), std::abs(z - x));
  });
  out.erase(std::unique(out.begin(), out.end()), out.end());
  for (double& y : out)
    if (y == 0) y = 0;  // not -0
  return out;
}

// ---- Shrinking

class Shrinking {
 public:
  Shrinking(const CaseMeshes& start, const AskCase& ask, const MinimiseOptions& options)
      : ask_(ask),
        options_(options),
        now_(start),
        size_(size_of(start)),
        degenerate_(degenerate_faces(start)) {
    answer_ = ask_(now_);
    calls_ = cost_of(answer_);
    kind_ = failure_of(case_of(now_), answer_);
  }

  FailureKind kind() const { return kind_; }

  Minimised run() {
    Minimised out;
    out.before = size_;
    triangulate();
    CaseSize last;
    do {
      last = size_;
      move_into_world();
      take_one_pair();
      drop_simplices();
      merge_vertices();
      shorten_poses();
      shorten_coordinates();
    } while (size_ < last && !spent());
    out.meshes = now_;
    out.kind = kind_;
    out.answer = answer_;
    out.after = size_;
    out.calls = calls_;
    out.complete = !spent();
    return out;
  }

 private:
  static std::uint64_t cost_of(const Replay& answer) {
    return answer.record.outcome == Outcome::timed_out ? kCallsOfTimeout : 1;
  }
  bool spent() const { return calls_ >= options_.max_calls; }

  bool is_confirmed(const CaseMeshes& c) {
    if (!options_.confirm) return true;
    const Replay answer = options_.confirm(c);
    calls_ += cost_of(answer);
    return failure_of(case_of(c), answer) == kind_;
  }

  /// Takes a case if it is smaller and fails in the same way. Faces that have area keep some: engines often
  /// reject faces without.
  bool attempt(const CaseMeshes& c) {
    if (spent() || c.a.face_count() == 0 || c.b.face_count() == 0) return false;
    const CaseSize size = size_of(c);
    if (!(size < size_) || !tried_.insert(text_of(c)).second) return false;
    const std::uint64_t degenerate = degenerate_faces(c);
    if (degenerate > degenerate_) return false;
    const Replay answer = ask_(c);
    calls_ += cost_of(answer);
    if (options_.progress) options_.progress(calls_, size_);
    if (failure_of(case_of(c), answer) != kind_ || !is_confirmed(c)) return false;
    now_ = c;
    size_ = size;
    degenerate_ = degenerate;
    answer_ = answer;
    return true;
  }

  static Mesh& mesh(CaseMeshes& c, std::size_t side) { return side == 0 ? c.a : c.b; }
  static Pose& pose(CaseMeshes& c, std::size_t side) { return side == 0 ? c.pose_a : c.pose_b; }

  /// Replaces poses by vertices in the world.
  void move_into_world() {
    const auto moved = [&](bool of_a, bool of_b) {
      CaseMeshes c = now_;
      for (std::size_t side = 0; side < 2; ++side) {
        if (!(side == 0 ? of_a : of_b)) continue;
        mesh(c, side) = methods::at_pose(mesh(c, side), pose(c, side));
        pose(c, side) = Pose{};
      }
      return c;
    };
    for (const auto& [of_a, of_b] : {std::pair{true, true}, {true, false}, {false, true}})
      attempt(moved(of_a, of_b));
  }

  /// Replaces polygons by triangles, if the case fails without them as well.
  void triangulate() {
    const CaseMeshes c = {simplices_of(now_.a), simplices_of(now_.b), now_.pose_a, now_.pose_b};
    const Replay answer = ask_(c);
    calls_ += cost_of(answer);
    if (failure_of(case_of(c), answer) != kind_ || !is_confirmed(c)) return;
    now_ = c;
    degenerate_ = degenerate_faces(c);  // also triangles of polygons with corners in a line
    answer_ = answer;
  }

  /// A single pair of simplices is nearly always enough.
  void take_one_pair() {
    if (now_.a.face_count() + now_.b.face_count() <= 2) return;
    static constexpr std::size_t kMaxPairs = 100;
    Pairs pairs = wrong_pairs(case_of(now_), answer_);
    if (pairs.size() > kMaxPairs) pairs.resize(kMaxPairs);
    const CaseMeshes all = now_;
    for (const SimplexPair& p : pairs) {
      CaseMeshes c = all;
      const auto one = [](const Mesh& m, SimplexId s) {
        const Mesh simplices = simplices_of(m);
        return part_of(simplices, [&](FaceId f) { return f.value() == s.value(); });
      };
      c.a = one(all.a, p.a);
      c.b = one(all.b, p.b);
      if (attempt(c)) return;
    }
  }

  /// Drops runs of faces of both bodies: halves, quarters, and so on down to single ones.
  void drop_simplices() {
    for (std::size_t length = (now_.a.face_count() + now_.b.face_count()) / 2; length > 0; length /= 2) {
      for (std::size_t begin = 0; begin < now_.a.face_count() + now_.b.face_count() && !spent();) {
        CaseMeshes c = now_;
        const std::size_t of_a = now_.a.face_count();
        const auto keep = [&](std::size_t i) { return i < begin || i >= begin + length; };
        c.a = part_of(now_.a, [&](FaceId f) { return keep(f); });
        c.b = part_of(now_.b, [&](FaceId f) { return keep(of_a + f); });
        if (!attempt(c)) begin += length;
      }
    }
  }

  /// Merges the ends of edges, which keeps closed surfaces closed, and vertices with equal coordinates.
  void merge_vertices() {
    for (std::size_t side = 0; side < 2; ++side) {
      bool again = true;
      while (again && !spent()) {
        again = false;
        std::set<std::pair<VertexId, VertexId>> edges;
        const Mesh& m = mesh(now_, side);
        for (FaceId f = 0; f < m.face_count(); ++f) {
          const auto corners = m.face(f);
          for (std::size_t k = 0; k < corners.size(); ++k)
            edges.insert({corners[k], corners[(k + 1) % corners.size()]});
        }
        for (std::uint32_t v = 0; v < m.vertices.size(); ++v)
          for (std::uint32_t w = 0; w < v; ++w)
            if (m.vertices[v] == m.vertices[w]) edges.insert({VertexId(v), VertexId(w)});
        for (const auto& [from, to] : edges) {
          CaseMeshes c = now_;
          mesh(c, side) = merged(mesh(now_, side), from, to);
          if (attempt(c)) {
            again = true;
            break;
          }
        }
      }
    }
  }

  /// Rounds rotations to rotations of the grid, and shortens translations.
  void shorten_poses() {
    for (std::size_t side = 0; side < 2; ++side) {
      if (is_identity(pose(now_, side))) continue;
      CaseMeshes c = now_;
      Eigen::Matrix3d& r = pose(c, side).r;
      r = Eigen::Matrix3d::Identity();
      if (!attempt(c)) {
        c = now_;
        r = pose(now_, side).r.array().round().matrix();
        if (turns_grid(pose(c, side)) && std::abs(r.determinant()) == 1) attempt(c);
      }
      for (int k = 0; k < 3; ++k)
        for (const double x : replacements(pose(now_, side).t[k], {})) {
          c = now_;
          pose(c, side).t[k] = x;
          if (attempt(c)) break;
        }
    }
  }

  /// Returns the coordinates along an axis; -1: all.
  std::set<double> numbers(int axis = -1) const {
    std::set<double> out;
    for (const Mesh* m : {&now_.a, &now_.b})
      for (const Vector3d& v : m->vertices)
        for (int k = 0; k < m->dim; ++k)
          if (axis < 0 || k == axis) out.insert(v[k]);
    return out;
  }

  /// Applies a function to all coordinates: f(side, vertex, axis, value).
  template <class Function>
  bool attempt_on_all(const Function& f) {
    CaseMeshes c = now_;
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t v = 0; v < mesh(c, side).vertices.size(); ++v)
        for (int k = 0; k < mesh(c, side).dim; ++k) {
          double& x = mesh(c, side).vertices[v][k];
          x = f(side, v, k, x);
          if (x == 0) x = 0;  // not -0
          if (!std::isfinite(x)) return false;
        }
    return attempt(c);
  }

  /// The same for the coordinates along an axis (-1: all): f(axis, value).
  template <class Function>
  bool attempt_on_axis(int axis, const Function& f) {
    return attempt_on_all(
        [&](std::size_t, std::size_t, int k, double x) { return axis < 0 || k == axis ? f(k, x) : x; });
  }

  void shorten_coordinates() {
    static constexpr std::uint64_t kMaxNumbers = 400;  // of a case whose numbers are tried one by one
    translate();
    scale();
    rank();
    snap();
    mirror();
    if (numbers().size() > kMaxNumbers) return;
    replace_equal_numbers();
    replace_single_numbers();
  }

  /// Moves the case so that a vertex is at 0, in all axes or in one.
  void translate() {
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t i = 0; i < mesh(now_, side).vertices.size(); ++i) {
        const Vector3d by = mesh(now_, side).vertices[i];
        for (int axis = -1; axis < 3; ++axis)
          attempt_on_axis(axis, [&](int k, double x) { return x - by[k]; });
      }
  }

  /// Scales by powers of two, so that the largest or the smallest number is about 1; all axes, or one.
  void scale() {
    for (int axis = -1; axis < 3; ++axis) {
      double largest = 0, smallest = HUGE_VAL;
      for (const double x : numbers(axis)) {
        if (x == 0) continue;
        largest = std::max(largest, std::abs(x));
        smallest = std::min(smallest, std::abs(x));
      }
      if (largest == 0) continue;
      for (const double one : {largest, smallest})
        for (int shift = -2; shift <= 4; ++shift) {
          const int by = shift - std::ilogb(one);
          attempt_on_axis(axis, [&](int, double x) { return std::ldexp(x, by); });
        }
    }
  }

  /// Replaces numbers by their ranks, counted from the least, or from 0.
  void rank() {
    for (int axis = -1; axis < 3; ++axis)
      for (const bool from_zero : {true, false}) {
        const std::array<std::set<double>, 3> values = {numbers(0), numbers(1), numbers(2)};
        attempt_on_axis(axis, [&](int k, double x) {
          const auto& all = values[static_cast<std::size_t>(k)];
          const auto begin = from_zero ? all.lower_bound(0) : all.begin();
          const auto at = all.find(x);
          return x < 0 && from_zero ? -static_cast<double>(std::distance(at, begin))
                                    : static_cast<double>(std::distance(begin, at));
        });
      }
  }

  /// Rounds all numbers to a grid, as coarse as possible.
  void snap() {
    for (int axis = -1; axis < 3; ++axis) {
      double largest = 0;
      for (const double x : numbers()) largest = std::max(largest, std::abs(x));
      if (largest == 0) return;
      for (int bits = 0; bits < 53; ++bits) {
        const double unit = std::ldexp(1, std::ilogb(largest) - bits);
        if (unit == 0) break;
        if (attempt_on_axis(axis, [&](int, double x) { return std::nearbyint(x / unit) * unit; })) break;
      }
    }
  }

  /// Fewer negative numbers.
  void mirror() {
    for (int axis = 0; axis < 3; ++axis) attempt_on_axis(axis, [](int, double x) { return -x; });
  }

  /// Equal numbers are replaced together: all of them, those of one axis, those of one body and axis. Planes
  /// and edges along axes stay what they are.
  void replace_equal_numbers() {
    for (const double old : numbers())
      for (int axis = -1; axis < 3; ++axis)
        for (int of = -1; of < 2; ++of)
          for (const double x : replacements(old, numbers())) {
            const bool taken = attempt_on_all([&](std::size_t side, std::size_t, int k, double y) {
              const bool hit = y == old && (axis < 0 || k == axis) && (of < 0 || side == std::size_t(of));
              return hit ? x : y;
            });
            if (taken) break;
          }
  }

  void replace_single_numbers() {
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t v = 0; v < mesh(now_, side).vertices.size(); ++v)
        for (int k = 0; k < mesh(now_, side).dim; ++k)
          for (const double x : replacements(mesh(now_, side).vertices[v][k], numbers())) {
            CaseMeshes c = now_;
            mesh(c, side).vertices[v][k] = x;
            if (attempt(c)) break;
          }
  }

  const AskCase& ask_;
  const MinimiseOptions& options_;
  CaseMeshes now_;
  CaseSize size_;
  FailureKind kind_ = FailureKind::none;
  std::uint64_t degenerate_;
  Replay answer_;
  std::uint64_t calls_ = 0;
  std::unordered_set<std::string> tried_;
};

}  // namespace

FailureKind failure_of(const cases::Case& c, const Replay& answer) {
  const Record& r = answer.record;
  if (r.outcome == Outcome::crashed) return FailureKind::crashes;
  if (r.outcome == Outcome::timed_out) return FailureKind::times_out;
  if (r.outcome != Outcome::wrong) return FailureKind::none;
  if (r.missed > 0) {
    const Pairs pairs = wrong_pairs(c, answer);
    return crosses(c, pairs.front()) ? FailureKind::misses_crossing : FailureKind::misses_touching;
  }
  return r.extra > 0 ? FailureKind::adds : FailureKind::relation;
}

std::optional<SimplexPair> failing_pair(const cases::Case& c, const Replay& answer) {
  const Pairs pairs = wrong_pairs(c, answer);
  if (pairs.empty()) return std::nullopt;
  return pairs.front();
}

int bits_of(double x) {
  if (x == 0) return 0;
  const int high = std::ilogb(x), low = high - (significand_bits(x) - 1);
  return std::max(high + 1, 0) + std::max(-low, 0) + (x < 0 ? 1 : 0);
}

CaseSize size_of(const CaseMeshes& c) {
  CaseSize out;
  for (const Mesh* m : {&c.a, &c.b}) {
    for (FaceId f = 0; f < m->face_count(); ++f)
      out.simplices += Mesh::simplices_of(m->face(f).size(), m->dim);
    out.vertices += m->vertices.size();
    for (const Vector3d& v : m->vertices)
      for (int k = 0; k < m->dim; ++k) {
        out.bits += static_cast<std::uint64_t>(bits_of(v[k]));
        out.largest = std::max(out.largest, std::abs(v[k]));
      }
  }
  for (const Pose* pose : {&c.pose_a, &c.pose_b}) {
    out.poses += is_identity(*pose) ? 0 : 1;
    if (is_identity(*pose)) continue;
    for (int i = 0; i < 3; ++i) {
      out.bits += static_cast<std::uint64_t>(bits_of(pose->t[i]));
      for (int j = 0; j < 3; ++j)
        out.bits +=
            static_cast<std::uint64_t>(pose->r(i, j) == (i == j ? 1 : 0) ? 0 : bits_of(pose->r(i, j)));
    }
  }
  return out;
}

Minimised minimise(const CaseMeshes& start, const AskCase& ask, const MinimiseOptions& options) {
  Shrinking shrinking(start, ask, options);
  if (shrinking.kind() == FailureKind::none)
    throw InputError(
        "the method does not fail on this case; expected a case whose outcome is wrong, crashed or timed_out");
  return shrinking.run();
}

}  // namespace lrb::stability
