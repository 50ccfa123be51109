// Bounds on the rounding of moving bodies, against arithmetic of 50 digits.
#include <array>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <doctest/doctest.h>

#include "engine/motion/motion_bounds.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/margins.hpp"

using namespace lrb;
using Eigen::Vector3d;

namespace {

using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using Real3 = std::array<Real, 3>;

Real3 times(const Eigen::Matrix3d& m, const Real3& x) {
  Real3 out;
  for (int i = 0; i < 3; ++i) out[i] = Real(m(i, 0)) * x[0] + Real(m(i, 1)) * x[1] + Real(m(i, 2)) * x[2];
  return out;
}

/// Returns exp(s [turn]) x, by Rodrigues' formula.
Real3 turned(const Vector3d& turn, const Real& s, const Real3& x) {
  const Real3 w = {turn.x(), turn.y(), turn.z()};
  const Real angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  if (angle == 0) return x;
  const Real3 u = {w[0] / angle, w[1] / angle, w[2] / angle};
  const Real cosine = cos(s * angle), sine = sin(s * angle), along = u[0] * x[0] + u[1] * x[1] + u[2] * x[2];
  Real3 out;
  for (int i = 0; i < 3; ++i)
    out[i] = x[i] * cosine + (u[(i + 1) % 3] * x[(i + 2) % 3] - u[(i + 2) % 3] * x[(i + 1) % 3]) * sine +
             u[i] * along * (1 - cosine);
  return out;
}

/// A vertex of a moving body, at a time of its motion: r E(t) (first.r x + first.t) + the path.
double share_of_position(std::span<const double> genes) {
  static const LrbRep body = test::open_body(shapes::tetrahedron());  // coordinates of 0 and 1
  const auto vector = [&](std::size_t at) {
    return Vector3d(2 * genes[at] - 1, 2 * genes[at + 1] - 1, 2 * genes[at + 2] - 1);
  };
  const Motion motion = Motion::turning(Pose::translation(vector(0)), 3 * vector(3), vector(6), vector(9));
  const Motion::Piece& piece = motion.pieces()[0];
  const MovingBody moving(body, piece);
  const double t = genes[12];
  const PieceState state = moving.at(t);
  const Real s = (Real(t) - Real(piece.begin)) / (Real(piece.end) - Real(piece.begin));
  Real most = 0;
  for (const Vector3d& x : body.vertices()) {
    const Vector3d found = state.pose.apply(x);
    Real3 z = times(piece.first.r, {x.x(), x.y(), x.z()});
    for (int i = 0; i < 3; ++i) z[i] += Real(piece.first.t[i]);
    const Real3 y = times(piece.r, turned(piece.turn, s, z));
    Real square = 0;
    for (int i = 0; i < 3; ++i) {
      const Real off = y[i] + (1 - s) * Real(piece.from[i]) + s * Real(piece.to[i]) - Real(found[i]);
      square += off * off;
    }
    if (square > most) most = square;
  }
  return static_cast<double>(Real(sqrt(most)) / Real(moving.rounding()));
}

}  // namespace

TEST_CASE("margins of moving bodies suffice") {
  // Of the sum of bounds in the worst direction at once, a search finds a tenth.
  const test::Margin rows[] = {{"position of a vertex", 13, share_of_position, 3000, 0.05}};
  test::check_margins(rows);
}
