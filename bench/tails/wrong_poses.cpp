#include "bench/tails/wrong_poses.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <nlohmann/json.hpp>

#include "scenarios/io/poses.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::tails {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUlp = 0x1p-52;

Corners corners_of(const LrbRep& rep, SimplexId s) {
  VertexId v[3] = {};
  rep.simplex(s, v);
  return {rep.vertices()[v[0]], rep.vertices()[v[1]], rep.vertices()[v[2]]};
}

Corners posed(const Corners& c, const Pose& pose) {
  return {pose.apply(c[0]), pose.apply(c[1]), pose.apply(c[2])};
}

class Maker {
 public:
  Maker(const LrbRep& a, const LrbRep& b, const PoseSpace& space, std::uint64_t seed)
      : a_(a), b_(b), space_(space), random_(seed) {}

  /// Returns a pose, and the direction in which it is moved by ulps.
  std::pair<Pose, Vector3d> make(Hard kind) {
    switch (kind) {
      case Hard::first_contact:
        return first_contact_pose();
      case Hard::coplanar_faces:
        return coplanar();
      case Hard::parallel_edges:
        return parallel();
      default:
        return vertex_on_vertex();
    }
  }

 private:
  bool meet(const Pose& pose) {
    CollideRequest request;
    request.mode = Mode::any_pair;
    return !collide(a_, Pose{}, b_, pose, request, workspace_).value().pairs.empty();
  }

  std::pair<Pose, Vector3d> first_contact_pose() {
    while (true) {
      Placement at = random_placement(random_);
      const Vector3d direction = at.offset.normalized();
      // From outside to the centre. The search ends at an interval that contains the first contact. Halving
      // it leads to two neighbouring doubles, with contact at the second.
      at.offset = 1.5 * direction;
      const Pose start = space_.pose(at);
      at.offset = Vector3d::Zero();
      const Pose end = space_.pose(at);
      const Motion motion = Motion::linear(start, end.t);
      FirstContactRequest request;
      request.relation = false;
      const FirstContactResult found = lrb::first_contact(a_, Motion::still(Pose{}), b_, motion, request);
      if (!found.is_contact() || found.at_start || found.passed) continue;
      double apart = found.t0, together = found.t1;
      for (double midpoint; (midpoint = apart + (together - apart) / 2) > apart && midpoint < together;)
        (meet(motion.at(midpoint)) ? together : apart) = midpoint;
      return {motion.at(together), direction};
    }
  }

  Corners random_face(const LrbRep& rep) {
    return corners_of(rep, SimplexId(random_.below(rep.real_simplex_count())));
  }

  /// Returns a rotation that maps a direction to another, followed by a random one about that.
  Matrix3d rotation_to(const Vector3d& from, const Vector3d& to) {
    const Matrix3d aligned = deterministic::turn_between(from, to).toRotationMatrix();
    return deterministic::rotation(to.normalized(), random_.in(0, 6.283185307179586)) * aligned;
  }

  std::pair<Pose, Vector3d> coplanar() {
    while (true) {
      const Corners f = random_face(a_), g = random_face(b_);
      const Vector3d n = (f[1] - f[0]).cross(f[2] - f[0]), m = (g[1] - g[0]).cross(g[2] - g[0]);
      if (!(n.norm() > 0) || !(m.norm() > 0)) continue;
      const Matrix3d r = rotation_to(m, -n);
      return {{r, (f[0] + f[1] + f[2]) / 3 - r * ((g[0] + g[1] + g[2]) / 3)}, n.normalized()};
    }
  }

  std::pair<Pose, Vector3d> parallel() {
    while (true) {
      const Corners f = random_face(a_), g = random_face(b_);
      const Vector3d e = f[1] - f[0], d = g[1] - g[0], n = e.cross(f[2] - f[0]);
      if (!(n.norm() > 0) || !(d.norm() > 0)) continue;
      const Matrix3d r = rotation_to(d, e);
      return {{r, (f[0] + f[1]) / 2 - r * ((g[0] + g[1]) / 2)}, n.normalized()};
    }
  }

  /// One of the 24 rotations that map axes to axes, exactly.
  std::pair<Pose, Vector3d> vertex_on_vertex() {
    std::array<int, 3> axes = {0, 1, 2};
    random_.shuffle(axes);
    Matrix3d r = Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) r(i, axes[static_cast<std::size_t>(i)]) = random_.below(2) == 0 ? 1 : -1;
    if (r.determinant() < 0) r.row(0) *= -1;
    const Corners f = random_face(a_), g = random_face(b_);
    Vector3d axis = Vector3d::Zero();
    axis[static_cast<int>(random_.below(3))] = 1;
    return {{r, f[0] - r * g[0]}, axis};
  }

  const LrbRep &a_, &b_;
  const PoseSpace& space_;
  Random random_;
  Workspace workspace_;
};

}  // namespace

std::vector<HardPose> hard_poses(const LrbRep& a, const LrbRep& b, const PoseSpace& space, std::size_t count,
                                 std::uint64_t seed, const run::ProgressReport& progress) {
  Maker maker(a, b, space, seed);
  std::vector<HardPose> out;
  for (std::size_t group = 0; out.size() < count; ++group) {
    const Hard kind = kEnumNames<Hard>[group % kEnumNames<Hard>.size()].value;
    const auto [pose, direction] = maker.make(kind);
    for (const int ulps : kUlps) {
      if (out.size() == count) break;
      out.push_back({kind, ulps, {pose.r, pose.t + (ulps * kUlp * space.unit()) * direction}});
    }
    progress("hard poses", out.size(), count);
  }
  return out;
}

double signed_gap(const Corners& a, const Corners& b) {
  double best = -std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Vector3d& axis, double scale) {
    // An axis that is short beside the edges that it comes from is rounding.
    constexpr double kNoise = 1e-10;
    const double length = axis.norm();
    if (!(length > kNoise * scale)) return;
    double low[2], high[2];
    const Corners* const triangles[2] = {&a, &b};
    for (int side = 0; side < 2; ++side) {
      low[side] = high[side] = 0;
      for (int k = 0; k < 3; ++k) {
        const double x = axis.dot((*triangles[side])[static_cast<std::size_t>(k)] - a[0]) / length;
        low[side] = k == 0 ? x : std::min(low[side], x);
        high[side] = k == 0 ? x : std::max(high[side], x);
      }
    }
    best = std::max(best, std::max(low[0] - high[1], low[1] - high[0]));
  };
  const auto edge = [](const Corners& t, std::size_t i) -> Vector3d { return t[(i + 1) % 3] - t[i]; };
  for (const Corners* t : {&a, &b}) {
    const Vector3d n = edge(*t, 0).cross(edge(*t, 1));
    const double scale = edge(*t, 0).norm() * edge(*t, 1).norm();
    try_axis(n, scale);
    // In the plane of a triangle, for coplanar ones.
    for (std::size_t i = 0; i < 3; ++i) try_axis(n.cross(edge(*t, i)), scale * edge(*t, i).norm());
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      try_axis(edge(a, i).cross(edge(b, j)), edge(a, i).norm() * edge(b, j).norm());
  return best;
}

std::vector<Judged> WrongSearch::worst(std::size_t most) const {
  std::vector<Judged> out;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(out),
               [](const Judged& j) { return j.wrong_pairs() || j.wrong_contact(); });
  std::stable_sort(out.begin(), out.end(), [](const Judged& p, const Judged& q) {
    return p.wrong_contact() != q.wrong_contact() ? p.wrong_contact() : p.error > q.error;
  });
  if (out.size() > most) out.erase(out.begin() + static_cast<std::ptrdiff_t>(most), out.end());
  return out;
}

WrongSearch find_wrong(Engine& engine, const LrbRep& a, const LrbRep& b, const PoseSpace& space,
                       std::size_t budget, std::uint64_t seed, const run::ProgressReport& progress) {
  WrongSearch out;
  out.engine = engine.name();
  out.seed = seed;
  const std::vector<HardPose> hard = hard_poses(a, b, space, budget, seed, progress);
  std::vector<Pose> poses;
  std::transform(hard.begin(), hard.end(), std::back_inserter(poses),
                 [](const HardPose& h) { return h.pose; });
  std::vector<EngineAnswer> answers =
      engine.ask(poses, {.list = true}, [&](std::size_t done) { progress(out.engine, done, poses.size()); });
  Workspace workspace;
  for (std::size_t i = 0; i < hard.size(); ++i) {
    Judged& judged = out.poses.emplace_back();
    judged.at = hard[i];
    judged.answer = std::move(answers[i]);
    progress("exact answers", i + 1, hard.size());
    const std::vector<SimplexPair> exact =
        std::move(collide(a, Pose{}, b, poses[i], CollideRequest{}, workspace).value().pairs);
    judged.exact_pairs = exact.size();
    if (!judged.answer.failure.empty()) continue;
    std::vector<SimplexPair> missed, extra;
    const std::vector<SimplexPair>& found = judged.answer.list;
    for (const SimplexPair& p : found)
      if (p.a >= a.real_simplex_count() || p.b >= b.real_simplex_count())
        throw InputError(printable_name(out.engine) +
                         ": expected pairs of faces of the two bodies, found one of others; does it read the "
                         "same triangles in the same order?");
    std::set_difference(exact.begin(), exact.end(), found.begin(), found.end(), std::back_inserter(missed));
    std::set_difference(found.begin(), found.end(), exact.begin(), exact.end(), std::back_inserter(extra));
    judged.missed = missed.size();
    judged.extra = extra.size();
    for (const std::vector<SimplexPair>* pairs : {&missed, &extra})
      for (const SimplexPair& p : *pairs)
        judged.error = std::max(
            judged.error,
            std::abs(signed_gap(corners_of(a, p.a), posed(corners_of(b, p.b), poses[i]))) / space.unit());
  }
  return out;
}

namespace {

const std::vector<std::string> kKindColumns = {"poses",        "number",      "no answer",    "wrong contact",
                                               "missed pairs", "false pairs", "largest error"};

/// Returns a row for each kind of poses.
std::vector<std::vector<std::string>> rows_of(const WrongSearch& search) {
  std::vector<std::vector<std::string>> out;
  for (const EnumName<Hard>& kind : kEnumNames<Hard>) {
    std::uint64_t number = 0, failed = 0, contacts = 0, missed = 0, extra = 0;
    double error = 0;
    for (const Judged& j : search.poses) {
      if (j.at.kind != kind.value) continue;
      ++number;
      failed += j.answer.failure.empty() ? 0 : 1;
      contacts += j.wrong_contact() ? 1 : 0;
      missed += j.missed;
      extra += j.extra;
      error = std::max(error, j.error);
    }
    out.push_back({io::in_words(kind.name), std::to_string(number), std::to_string(failed),
                   std::to_string(contacts), std::to_string(missed), std::to_string(extra),
                   io::number_text(error, 3)});
  }
  return out;
}

}  // namespace

std::string table_of(const WrongSearch& search) {
  std::vector<std::vector<std::string>> rows = rows_of(search);
  rows.insert(rows.begin(), kKindColumns);
  return report::in_columns(rows);
}

std::vector<nlohmann::ordered_json> json_of(const WrongSearch& search) {
  std::vector<nlohmann::ordered_json> out;
  for (const Judged& j : search.worst())
    out.push_back({{"engine", search.engine},
                   {"goal", "wrong"},
                   {"poses", name_of(j.at.kind)},
                   {"ulps", j.at.ulps},
                   {"pairs", j.answer.pairs},
                   {"exact_pairs", j.exact_pairs},
                   {"missed", j.missed},
                   {"false", j.extra},
                   {"error", j.error},
                   {"b", io::rows_of(j.at.pose)}});
  return out;
}

std::vector<std::string> write_wrong_page(const WrongSearch& search, const std::string& title,
                                          const std::string& command, const std::string& scenario,
                                          const std::vector<std::string>& recorders,
                                          const std::string& folder) {
  report::Document document(
      title,
      "An engine's pairs of intersecting faces at poses that are hard in floating point, compared with the "
      "exact ones: at first contact, with coplanar faces, with parallel edges, with vertices on vertices, "
      "and beside them, from one unit in the last place of doubles up to the rounding of single precision.");
  document.table(
      {"Kinds of poses", kKindColumns, rows_of(search),
       "Error: the gap of triangles that were reported but do not intersect, or the depth of those that "
       "were missed, over the mean of both bodies' diagonals. An error near the engine's rounding "
       "(1e-16 of the coordinates in double, 6e-8 in single precision) is unavoidable."});
  report::Table worst{"The worst poses",
                      {"poses", "ulps", "pairs", "exact pairs", "missed", "false", "error", "recorded by"}};
  const std::vector<Judged> judged = search.worst();
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const Judged& j = judged[i];
    worst.rows.push_back({io::in_words(name_of(j.at.kind)), std::to_string(j.at.ulps),
                          std::to_string(j.answer.pairs), std::to_string(j.exact_pairs),
                          std::to_string(j.missed), std::to_string(j.extra), io::number_text(j.error, 3),
                          recorders[i]});
  }
  if (judged.empty()) worst.note = "No pair was missed or reported falsely.";
  document.table(worst);
  if (!scenario.empty())
    document.file("worst.scenario.json", scenario, "the poses with the exact answers, for regression tests");
  document.command(command);
  document.write(report::Folder(folder));
  return document.notes();
}

}  // namespace lrb::tails
