#include "engine/query/near_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "engine/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// Simplices of a body as PairBlock has them, about an origin amid them.
class SimplexWriter {
 public:
  SimplexWriter(const LrbRep& rep, double unit, SimplexId amid) : rep_(rep), per_unit_(1 / unit) {
    VertexId v[3] = {};
    rep.simplex(amid, v);
    origin_ = rep.vertices()[v[0]] * per_unit_;
  }

  struct Written {
    Vector3d first;
    double longest;  ///< edge from the first corner
  };
  Written write(SimplexId s, float (&to)[3][3][8], std::size_t lane) {
    VertexId v[3] = {};
    rep_.simplex(s, v);
    if (rep_.simplex_size() == 2) v[2] = v[1];
    const Vector3d x = rep_.vertices()[v[0]] * per_unit_, first = x - origin_;
    const Vector3d edges[2] = {rep_.vertices()[v[1]] * per_unit_ - x, rep_.vertices()[v[2]] * per_unit_ - x};
    for (int axis = 0; axis < 3; ++axis) {
      to[0][axis][lane] = static_cast<float>(first[axis]);
      for (int edge = 0; edge < 2; ++edge) to[1 + edge][axis][lane] = static_cast<float>(edges[edge][axis]);
    }
    farthest_sq_ = std::max(farthest_sq_, first.squaredNorm());
    return {first, std::sqrt(std::max(edges[0].squaredNorm(), edges[1].squaredNorm()))};
  }

  const Vector3d& origin() const { return origin_; }
  /// Of a ball about the origin that holds all first corners that were written.
  float radius() const { return static_cast<float>(std::sqrt(farthest_sq_)) * kFloatUp + kKernelTiny; }

 private:
  const LrbRep& rep_;
  double per_unit_;  // a power of two, as the unit is
  Vector3d origin_;
  double farthest_sq_ = 0;
};

/// A block's sizes are the largest of its pairs'.
template <class Size>
void include(PairBlock& block, const Size& size) {
  block.edge_a = std::max(block.edge_a, size.edge_a);
  block.edge_b = std::max(block.edge_b, size.edge_b);
  block.reach = std::max(block.reach, size.reach);
}

void copy_lane(const PairBlock& from, std::size_t lane, PairBlock& to, std::size_t to_lane) {
  for (int which = 0; which < 3; ++which)
    for (int axis = 0; axis < 3; ++axis) {
      to.a[which][axis][to_lane] = from.a[which][axis][lane];
      to.b[which][axis][to_lane] = from.b[which][axis][lane];
    }
}

}  // namespace

void NearPairs::arrange(const LrbRep& a, const LrbRep& b, const TreeKernel& k, double margin,
                        double rounding) {
  unit_ = std::max(a.tree().unit(), b.tree().unit());
  fill_blocks(a, b, k);
  gaps_.resize(8 * blocks_.size());
  PairKernel kernel = kernel_at(k, 0, pairs_.size());
  kernel.gaps = gaps_.data();
  run_pair_kernel(kernel);
  sort_by_shell(margin, rounding);
  meeting_.assign(blocks_.size(), {});
  meeting_blocks_ = 0;
}

void NearPairs::fill_blocks(const LrbRep& a, const LrbRep& b, const TreeKernel& k) {
  blocks_.assign((pairs_.size() + 7) / 8, {});
  verdicts_.resize(blocks_.size());
  sizes_.clear();
  if (pairs_.empty()) return;
  const SimplexPair amid = pairs_[pairs_.size() / 2];
  SimplexWriter of_a(a, unit_, amid.a), of_b(b, unit_, amid.b);
  middle_[0] = of_a.origin();
  middle_[1] = of_b.origin();
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = k.m[j][i];
  const Vector3d t = offset_at(k);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    PairBlock& block = blocks_[i / 8];
    const auto in_a = of_a.write(pairs_[i].a, block.a, i % 8), in_b = of_b.write(pairs_[i].b, block.b, i % 8);
    const double between = (m * in_b.first + t - in_a.first).norm();
    const Size size{
        static_cast<float>(in_a.longest) * kFloatUp + kKernelTiny,
        static_cast<float>(in_b.longest) * kFloatUp + kKernelTiny,
        static_cast<float>(between + in_a.longest + static_cast<double>(k.m_size) * in_b.longest) * kFloatUp +
            kKernelTiny};
    sizes_.push_back(size);
    include(block, size);
  }
  radius_[0] = of_a.radius();
  radius_[1] = of_b.radius();
}

/// kShells: beyond the margin.
int NearPairs::shell_of(std::size_t i, double margin, double rounding) const {
  if ((verdicts_[i / 8].cross >> i % 8 & 1) != 0) return 0;
  const double gap = static_cast<double>(gaps_[i]) * unit_ - rounding;
  if (!(gap > 0)) return 1;
  return gap >= margin ? kShells : std::min(kShells - 1, 1 + static_cast<int>(gap / shell_width_));
}

/// Within a shell pairs stay in the order in which they came.
void NearPairs::sort_by_shell(double margin, double rounding) {
  shell_width_ = margin / (kShells - 1);
  std::fill(std::begin(shell_end_), std::end(shell_end_), 0);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (const int shell = shell_of(i, margin, rounding); shell < kShells) ++shell_end_[shell];
  std::size_t place[kShells], before = 0;
  for (int shell = 0; shell < kShells; ++shell) {
    place[shell] = before;
    before += shell_end_[shell];
    shell_end_[shell] = before;
  }
  sorted_.resize(before);
  sorted_blocks_.assign((before + 7) / 8, {});
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const int shell = shell_of(i, margin, rounding);
    if (shell == kShells) continue;
    const std::size_t to = place[shell]++;
    PairBlock& block = sorted_blocks_[to / 8];
    sorted_[to] = pairs_[i];
    copy_lane(blocks_[i / 8], i % 8, block, to % 8);
    include(block, sizes_[i]);
  }
  pairs_.swap(sorted_);
  blocks_.swap(sorted_blocks_);
}

std::size_t NearPairs::within(double distance) const {
  // A little more, for the rounding of the division by the width.
  const double shell = 1 + distance / shell_width_ + 0x1p-20;
  return shell < kShells - 1 ? shell_end_[static_cast<int>(shell)] : shell_end_[kShells - 1];
}

Vector3d NearPairs::offset_at(const TreeKernel& k) const {
  Vector3d t;
  for (int i = 0; i < 3; ++i) {
    t[i] = k.t[i] - middle_[0][i];
    for (int j = 0; j < 3; ++j) t[i] += k.m[j][i] * middle_[1][j];
  }
  return t;
}

PairKernel NearPairs::kernel_at(const TreeKernel& k, double moved, std::size_t count) {
  PairKernel p{};
  p.moved = static_cast<float>(moved / unit_) * kFloatUp + kKernelTiny;
  p.blocks = blocks_.data();
  p.block_count = static_cast<std::uint32_t>((count + 7) / 8);
  p.verdicts = verdicts_.data();
  p.radius_a = radius_[0];
  p.radius_b = radius_[1];
  p.slack = k.slack;
  p.m_size = k.m_size;
  const Vector3d t = offset_at(k);
  for (int i = 0; i < 3; ++i) {
    std::copy(std::begin(k.m_rows[i]), std::end(k.m_rows[i]), p.r[i]);
    p.t[i] = static_cast<float>(t[i]);
  }
  return p;
}

void NearPairs::list_meeting(CollideResult& result) const {
  for (std::size_t i = 0; i < meeting_blocks_; ++i)
    for (unsigned left = unsigned{meeting_[i].cross} | meeting_[i].touch; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      result.pairs.push_back(pairs_[8 * i + static_cast<std::size_t>(lane)]);
      result.meets.push_back((meeting_[i].cross >> lane & 1) != 0 ? exact::Meet::cross : exact::Meet::touch);
    }
}

}  // namespace lrb
