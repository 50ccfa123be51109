#include "scenarios/crowd/crowd_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::crowd {
namespace {

Eigen::Vector3d random_direction(Random& random, int dim) {
  if (dim == 2) {
    const double angle = random.in(0, 2 * std::numbers::pi);
    return {steady::cos(angle), steady::sin(angle), 0};
  }
  while (true) {
    const double x = random.in(-1, 1);
    const double y = random.in(-1, 1);
    const double z = random.in(-1, 1);
    const Eigen::Vector3d d(x, y, z);
    if (d.norm() > 0.1 && d.norm() <= 1) return d.normalized();
  }
}

/// Returns places in rows over the room, shuffled: as many as there are bodies or a few more.
std::vector<Eigen::Vector3d> grid_places(const Eigen::Vector3d& reach, std::uint32_t count, int dim,
                                         Random& random) {
  const double side = dim == 2 ? std::sqrt(count) : std::cbrt(count);
  std::uint32_t n[3] = {1, 1, 1};
  for (int i = 0; i < dim; ++i) n[i] = std::max(1U, static_cast<std::uint32_t>(std::floor(side)));
  for (int i = 0; n[0] * n[1] * n[2] < count; ++i) ++n[i % dim];
  std::vector<Eigen::Vector3d> places;
  for (std::uint32_t k = 0; k < n[0] * n[1] * n[2]; ++k) {
    const std::uint32_t at[3] = {k % n[0], k / n[0] % n[1], k / n[0] / n[1]};
    Eigen::Vector3d p(0, 0, 0);
    for (int i = 0; i < dim; ++i) p[i] = n[i] > 1 ? reach[i] * (2.0 * at[i] / (n[i] - 1) - 1) : 0;
    places.push_back(p);
  }
  for (std::size_t k = places.size(); k > 1; --k) std::swap(places[k - 1], places[random.bits() % k]);
  return places;
}

/// Returns the coordinate of a point that moves straight on, seen between two mirrors at -reach and reach.
double thrown_back(double x, double reach) {
  if (!(reach > 0)) return 0;
  double y = std::fmod(x + reach, 4 * reach);
  if (y < 0) y += 4 * reach;
  return (y > 2 * reach ? 4 * reach - y : y) - reach;
}

/// Returns the largest distance of a body's points from its origin.
double radius_of(const LrbRep& rep, const Pose& own) {
  double r = 0;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) r = std::max(r, own.apply(rep.vertices()[v]).norm());
  return r;
}

std::vector<std::uint32_t> kinds_of_bodies(const spec::Crowd& crowd) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t k = 0; k < crowd.kinds.size(); ++k) out.insert(out.end(), crowd.kinds[k].count, k);
  return out;
}

}  // namespace

CrowdMotion::CrowdMotion(const spec::Crowd& crowd, std::vector<std::vector<Pose>> poses)
    : kinds_(kinds_of_bodies(crowd)), recorded_(std::move(poses)) {}

CrowdMotion::CrowdMotion(const spec::Crowd& crowd, std::span<const LrbRep* const> reps)
    : kinds_(kinds_of_bodies(crowd)) {
  const int dim = reps[0]->dim();
  Random random(crowd.seed);
  for (std::uint32_t k = 0; k < crowd.kinds.size(); ++k) {
    const Pose& own = crowd.kinds[k].body.pose;
    const double radius = radius_of(*reps[k], own);
    for (std::uint32_t i = 0; i < crowd.kinds[k].count; ++i) {
      Mover m;
      m.own = own;
      m.reach = (crowd.room / 2 - Eigen::Vector3d::Constant(radius)).cwiseMax(0);
      if (dim == 2) m.reach.z() = 0;
      for (int axis = 0; axis < 3; ++axis) m.start[axis] = random.in(-m.reach[axis], m.reach[axis]);
      m.speed = random_direction(random, dim);
      m.speed *= random.in(crowd.speed[0], crowd.speed[1]);
      m.axis = dim == 2 ? Eigen::Vector3d::UnitZ().eval() : random_direction(random, dim);
      m.turned = steady::rotation(m.axis, random.in(0, 2 * std::numbers::pi));
      if (dim == 3) m.axis = random_direction(random, dim);
      m.spin = random.in(crowd.spin[0], crowd.spin[1]) * std::numbers::pi / 180;
      movers_.push_back(m);
    }
  }
  if (crowd.arrangement == spec::Crowd::Arrangement::random) return;
  const auto places =
      grid_places(Eigen::Vector3d::Ones(), static_cast<std::uint32_t>(movers_.size()), dim, random);
  for (std::size_t i = 0; i < movers_.size(); ++i)
    movers_[i].start = places[i].cwiseProduct(movers_[i].reach);
}

Pose CrowdMotion::pose(std::uint32_t body, std::uint32_t step) const {
  if (!recorded_.empty()) return recorded_.at(step).at(body);
  const Mover& m = movers_[body];
  Pose move;
  const Eigen::Vector3d straight = m.start + static_cast<double>(step) * m.speed;
  for (int i = 0; i < 3; ++i) move.t[i] = thrown_back(straight[i], m.reach[i]);
  move.r = steady::rotation(m.axis, m.spin * step) * m.turned;
  return spec::then(m.own, move);
}

}  // namespace lrb::crowd
