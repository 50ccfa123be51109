#include "bench/engines/poses.hpp"

#include <algorithm>
#include <cmath>

#include "bench/methods/triangles.hpp"
#include <lrbscope/first_contact.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::engines {
namespace {

/// Returns a point that is uniformly distributed in a ball, without its centre, by rejection from the cube.
template <int n>
Eigen::Matrix<double, n, 1> in_ball(Random& random) {
  constexpr double kTiny = 1e-3;
  while (true) {
    Eigen::Matrix<double, n, 1> x;
    for (int i = 0; i < n; ++i) x[i] = random.in(-1, 1);
    if (const double sq = x.squaredNorm(); sq > kTiny * kTiny && sq < 1) return x;
  }
}

/// Returns a sample of about the standard normal distribution, without functions that processors round
/// differently.
double normal(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.in(0, 1);
  return sum;
}

/// Returns a placement nearby: each coordinate of the quaternion changes by about `sigma`, that of the offset
/// by half as much, normally distributed (the sum of 12 uniform numbers, cut off at 6 sigma).
Placement placement_near(const Placement& at, double sigma, Random& random) {
  Placement out = at;
  for (int i = 0; i < 4; ++i) out.turn.coeffs()[i] += sigma * normal(random);
  out.turn.normalize();
  for (int i = 0; i < 3; ++i) out.offset[i] += sigma / 2 * normal(random);
  return out;
}

constexpr double kFirstSigma = 0.1, kGrow = 1.5, kShrink = 0.9, kLeastSigma = 1e-5, kMaxSigma = 0.5;
constexpr std::size_t kBlock = 256;  // random trials asked together

void ask(Search& search, std::span<const Placement> placements, const CostsOf& costs,
         const SearchProgress& progress) {
  const std::vector<double> found = costs(placements);
  for (std::size_t i = 0; i < placements.size(); ++i)
    search.trials.push_back({placements[i], found[i], search.trials.size() + 1});
  progress(search.trials.size());
}

void ask_at_random(Search& search, std::size_t count, Random& random, const CostsOf& costs,
                   const SearchProgress& progress) {
  while (search.random < count) {
    std::vector<Placement> block;
    while (block.size() < kBlock && search.random + block.size() < count)
      block.push_back(random_placement(random));
    search.random += block.size();
    ask(search, block, costs, progress);
  }
}

}  // namespace

Placement random_placement(Random& random) {
  Placement out;
  const Eigen::Vector4d q = in_ball<4>(random).normalized();
  out.turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  const Eigen::Vector3d direction = in_ball<3>(random).normalized();
  out.offset = random.in(0, 1) * direction;
  return out;
}

bool alike(const Placement& p, const Placement& q, double angle, double distance) {
  // The rotations differ by twice the angle of the quaternions.
  const double cosine = std::abs(p.turn.dot(q.turn));
  return cosine > deterministic::cos(angle / 2) && (p.offset - q.offset).norm() < distance;
}

std::vector<Trial> Search::worst(std::size_t most) const {
  std::vector<Trial> sorted = trials;
  std::ranges::stable_sort(sorted, [](const Trial& p, const Trial& q) { return p.cost > q.cost; });
  std::vector<Trial> out;
  for (const Trial& t : sorted) {
    if (out.size() == most) break;
    if (std::ranges::none_of(out, [&](const Trial& o) { return alike(o.at, t.at); })) out.push_back(t);
  }
  return out;
}

Search search(const SearchOptions& options, const CostsOf& costs, const SearchProgress& progress) {
  Search out;
  Random random(options.seed);
  const auto first = static_cast<std::size_t>(options.random_share * static_cast<double>(options.budget));
  ask_at_random(out, std::min(options.budget, std::max(first, options.starts)), random, costs, progress);
  std::vector<Trial> best = out.worst(options.starts);
  std::vector<double> sigma(best.size(), kFirstSigma);
  while (out.trials.size() < options.budget) {
    std::vector<Placement> steps;
    for (std::size_t i = 0; i < best.size() && out.trials.size() + steps.size() < options.budget; ++i)
      steps.push_back(placement_near(best[i].at, sigma[i], random));
    const std::size_t begin = out.trials.size();
    ask(out, steps, costs, progress);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Trial& t = out.trials[begin + i];
      const bool better = t.cost > best[i].cost;
      if (better) best[i] = t;
      sigma[i] = better ? std::min(kMaxSigma, sigma[i] * kGrow) : std::max(kLeastSigma, sigma[i] * kShrink);
    }
  }
  return out;
}

// Hard poses.

namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUlp = 0x1p-52;

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
    return methods::corners_of(rep, Pose{}, SimplexId(random_.below(rep.real_simplex_count())));
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
                                 std::uint64_t seed) {
  Maker maker(a, b, space, seed);
  std::vector<HardPose> out;
  for (std::size_t group = 0; out.size() < count; ++group) {
    const Hard kind = kEnumNames<Hard>[group % kEnumNames<Hard>.size()].value;
    const auto [pose, direction] = maker.make(kind);
    for (const int ulps : kUlps) {
      if (out.size() == count) break;
      out.push_back({kind, ulps, {pose.r, pose.t + (ulps * kUlp * space.unit()) * direction}});
    }
  }
  return out;
}

}  // namespace lrb::engines
