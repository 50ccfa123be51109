// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_DIVIDE_KERNEL_NAME.
// 1. The different vertices of a range, and the moments of its simplices relative to its centre, in float.
// 2. Recursive cuts, by the surface area heuristic for oriented boxes. All cuts across the coordinate axes
//    are ranked by the moments of both halves, and of the two best ones that with the smaller tight boxes is
//    chosen. The orders along the axes are partitioned stably, so that no half is sorted again.
// 3. Leaves are filled from their different vertices, which are kept for the nodes above.

#include "engine/tree/kernel_frames.inl"

namespace lrb {
namespace {

using FloatMoments = Moments<Float4>;

/// Loads a row of DivideMemory::moments.
inline FloatMoments moments_at(const float* x) {
  return {load4(x), load4(x + 4), load4(x + 8)};
}

/// Moments of eight parts, lane by lane: means and covariances.
struct Covariances {
  Float8 xx, yy, zz, yz, zx, xy;

  explicit Covariances(const Float8 (&first)[4], const Float8 (&squares)[4], const Float8 (&products)[4]) {
    // At least the weight of a simplex: the difference of two sums may be rounded to less.
    const Float8 whole = splat(1) / larger(first[3], splat(static_cast<float>(kFrameCornerWeight)));
    const Float8 x = first[0] * whole, y = first[1] * whole, z = first[2] * whole;
    xx = squares[0] * whole - x * x, yy = squares[1] * whole - y * y, zz = squares[2] * whole - z * z;
    yz = products[0] * whole - y * z, zx = products[1] * whole - z * x, xy = products[2] * whole - x * y;
  }

  /// Estimates the costs of the tight boxes, up to a factor. Half the surface area of a box is about the root
  /// of the sum of the squared products of two standard deviations each, along principal axes. The axes are
  /// not needed: the radicand is the sum of the principal minors of the covariance.
  Float8 costs() const {
    const Float8 minors = yy * zz + zz * xx + xx * yy - (yz * yz + (zx * zx + xy * xy));
    // larger(x, 0) is 0 if x is NaN due to rounding.
    return root8(larger(minors, Float8{})) +
           static_cast<float>(kLengthCost) * larger(xx + (yy + zz), Float8{});
  }
};

/// Splits of one range and its parts.
class Division {
 public:
  explicit Division(DivideKernel& kernel) : k_(kernel), m_(*kernel.memory) {}

  /// Divides the range of a node down to leaves, except for parts that must be measured again.
  void divide(std::uint32_t self) {
    begin_ = k_.nodes[self].begin, self_ = self, leaf_ = 0;
    const std::uint32_t count = k_.nodes[self].end - begin_;
    number_vertices(count);
    measure(count);
    for (int axis = 0; axis < 3; ++axis) sort(axis, count);
    FloatMoments all;
    for (std::uint32_t i = 0; i < count; ++i) all += moments_at(m_.moments[i]);
    __builtin_memset(m_.seen, 0, sizeof m_.seen);
    split(self, 0, count, all, k_.nodes[self].cost);
  }

  std::uint32_t waiting[kSmallRange / kTreeWidth];  ///< nodes that must be measured again
  std::uint32_t waiting_count = 0;

 private:
  /// Finds the different vertices of the range, and its box.
  void number_vertices(std::uint32_t count) {
    __builtin_memset(m_.slot_vertex, 0xff, sizeof m_.slot_vertex);
    vertices_ = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t s = m_.simplex[i] = k_.order[begin_ + i];
      for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = k_.in.corners[std::size_t{3} * s + static_cast<std::size_t>(corner)];
        // Fibonacci hashing.
        std::uint32_t slot = vertex * 2654435769u >> 21;
        while (m_.slot_vertex[slot] != vertex && m_.slot_vertex[slot] != ~0u)
          slot = (slot + 1) % DivideMemory::kSlots;
        if (m_.slot_vertex[slot] != vertex) {
          m_.slot_vertex[slot] = vertex;
          m_.slot_number[slot] = static_cast<std::uint16_t>(vertices_);
          const double* const x = k_.in.vertices + std::size_t{3} * vertex;
          for (int j = 0; j < 3; ++j) m_.position[vertices_][j] = x[j] * k_.in.scale;
          m_.position[vertices_++][3] = 0;
        }
        m_.corner[i][corner] = m_.slot_number[slot];
      }
    }
    Double4 low = load4(m_.position[0]), high = low;
    for (std::uint32_t v = 1; v < vertices_; ++v) {
      low = smaller(low, load4(m_.position[v]));
      high = larger(high, load4(m_.position[v]));
    }
    const Double4 centre = 0.5 * (low + high), side = high - low;
    to_local_ = inverse_power_of_two(longest_of(side));
    for (std::uint32_t v = 0; v < vertices_; ++v) {
      const Float4 x = __builtin_convertvector((load4(m_.position[v]) - centre) * splat4d(to_local_), Float4);
      __builtin_memcpy(m_.point[v], &x, sizeof x);
    }
  }

  void measure(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Float4 p = load4(m_.point[m_.corner[i][0]]), q = load4(m_.point[m_.corner[i][1]]),
                   r = load4(m_.point[m_.corner[i][2]]);
      const FloatMoments moments(p, q, r, static_cast<float>(kFrameCornerWeight));
      const Float4 centre = smaller(p, smaller(q, r)) + larger(p, larger(q, r));
      __builtin_memcpy(m_.moments[i], &moments, sizeof moments);
      __builtin_memcpy(m_.moments[i] + 12, &centre, sizeof centre);
    }
  }

  /// Orders the range along an axis by the centres of boxes, up to a 512th of its length: a counting
  /// sort.
  void sort(int axis, std::uint32_t count) {
    constexpr std::uint32_t kParts = 512;
    std::uint16_t begin[kParts + 1] = {}, part[kSmallRange];
    float low = m_.moments[0][12 + axis], high = low;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float x = m_.moments[i][12 + axis];
      low = x < low ? x : low;
      high = x > high ? x : high;
    }
    const float per_unit = high - low > 1e-30f ? (kParts - 1) / (high - low) : 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      part[i] = static_cast<std::uint16_t>(static_cast<int>((m_.moments[i][12 + axis] - low) * per_unit));
      ++begin[part[i] + 1];
    }
    std::uint16_t sum = 0;
    for (std::uint16_t& b : begin) b = sum = static_cast<std::uint16_t>(sum + b);
    for (std::uint32_t i = 0; i < count; ++i) m_.order[axis][begin[part[i]]++] = static_cast<std::uint8_t>(i);
  }

  struct Cut {
    std::uint32_t axis, left;
    FloatMoments of_left;
    float left_cost, right_cost;
  };

  /// Ranks all cuts of a range and returns the best two.
  void rank(std::uint32_t begin, std::uint32_t end, const FloatMoments& all, Cut (&best)[2]) {
    const std::uint32_t cuts = (end - begin - 1) / kTreeWidth,
                        leaves = (end - begin + kTreeWidth - 1) / kTreeWidth;
    // The moments of the left half grow by one leaf per step; all axes at a time, which do not depend on each
    // other.
    FloatMoments left[3];
    for (std::uint32_t c = 0; c < cuts; ++c) {
      for (std::uint32_t i = begin + c * kTreeWidth; i < begin + (c + 1) * kTreeWidth; ++i)
        for (int axis = 0; axis < 3; ++axis) left[axis] += moments_at(m_.moments[m_.order[axis][i]]);
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        m_.cut_leaves[3 * c + axis] = static_cast<float>(c + 1);
        __builtin_memcpy(m_.cut_moments[3 * c + axis], &left[axis], sizeof left[axis]);
      }
    }
    for (std::uint32_t c = 0; c < 3 * cuts; c += 8) {
      Float8 part[3][4], rest[3][4];
      for (int row = 0; row < 3; ++row) {
        Float4 rows[8];
        for (std::uint32_t i = 0; i < 8; ++i) rows[i] = load4(m_.cut_moments[c + i] + 4 * row);
        transpose(rows, part[row]);
        const Float4 whole = row == 0 ? all.first : row == 1 ? all.squares : all.products;
        for (int i = 0; i < 4; ++i) rest[row][i] = splat(whole[i]) - part[row][i];
      }
      const Float8 count = load8(m_.cut_leaves + c);
      const Float8 cost =
          Covariances(part[0], part[1], part[2]).costs() * count +
          Covariances(rest[0], rest[1], rest[2]).costs() * (splat(static_cast<float>(leaves)) - count);
      __builtin_memcpy(m_.cut_cost + c, &cost, sizeof cost);
    }
    // Ties go to the most balanced cut, so that coincident simplices are halved.
    float least[2] = {__builtin_inff(), __builtin_inff()};
    std::uint32_t at[2] = {0, 0};
    const auto larger_side = [&](std::uint32_t c) {
      return c / 3 + 1 > cuts - c / 3 ? c / 3 + 1 : cuts - c / 3;
    };
    for (std::uint32_t c = 0; c < 3 * cuts; ++c) {
      const float cost = m_.cut_cost[c];
      if (!(cost < least[1]) && !(cost == least[1] && larger_side(c) < larger_side(at[1]))) continue;
      const bool is_first = cost < least[0] || (cost == least[0] && larger_side(c) < larger_side(at[0]));
      least[1] = is_first ? least[0] : cost;
      at[1] = is_first ? at[0] : c;
      if (is_first) least[0] = cost, at[0] = c;
    }
    for (int i = 0; i < 2; ++i)
      best[i] = {at[i] % 3, (at[i] / 3 + 1) * kTreeWidth, moments_at(m_.cut_moments[at[i]]), 0, 0};
  }

  /// Computes the costs of the tight boxes of the halves of two cuts. The first cut is in lanes 0 to 2, one
  /// axis of its halves each, the second one in lanes 4 to 6.
  void fit(std::uint32_t begin, std::uint32_t end, const FloatMoments& all, Cut (&cuts)[2]) {
    Float4 rows[3][8];
    for (int i = 0; i < 8; ++i) {
      const FloatMoments& left = cuts[i / 2 % 2].of_left;
      const FloatMoments x = i % 2 == 0 ? left : all - left;
      rows[0][i] = x.first, rows[1][i] = x.squares, rows[2][i] = x.products;
    }
    Float8 columns[3][4], axes[3][3];
    for (int row = 0; row < 3; ++row) transpose(rows[row], columns[row]);
    const Covariances m(columns[0], columns[1], columns[2]);
    find_axes(m.xx, m.yy, m.zz, m.yz, m.zx, m.xy, 1e-30, axes);
    // Simplices by their sides of both cuts: bit k of the group is set right of cut k.
    for (std::uint32_t i = begin; i < end; ++i)
      m_.side[m_.order[cuts[1].axis][i]] = i < begin + cuts[1].left ? 0 : 2;
    std::uint8_t group[4][kSmallRange];
    std::uint32_t size[4] = {};
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint8_t s = m_.order[cuts[0].axis][i];
      const std::uint32_t g = m_.side[s] + (i < begin + cuts[0].left ? 0u : 1u);
      group[g][size[g]++] = s;
    }
    // Rows of the axes of each half.
    Float4 row[4][3];
    for (int half = 0; half < 4; ++half)
      for (int j = 0; j < 3; ++j)
        row[half][j] = Float4{axes[0][j][half], axes[1][j][half], axes[2][j][half], 0};
    Float8 low[4], high[4];
    for (int g = 0; g < 4; ++g) {
      low[g] = splat(__builtin_inff()), high[g] = -low[g];
      const Float4 *const of_first = row[g % 2], *const of_second = row[2 + g / 2];
      const Float8 turn[3] = {join(of_first[0], of_second[0]), join(of_first[1], of_second[1]),
                              join(of_first[2], of_second[2])};
      for (std::uint32_t i = 0; i < size[g]; ++i)
        for (int corner = 0; corner < 3; ++corner) {
          const float* const x = m_.point[m_.corner[group[g][i]][corner]];
          const Float8 y = splat(x[0]) * turn[0] + splat(x[1]) * turn[1] + splat(x[2]) * turn[2];
          low[g] = smaller(low[g], y);
          high[g] = larger(high[g], y);
        }
    }
    // The groups of each side.
    const auto cost_of = [&](int cut, int x, int y) {
      const Float8 sides = larger(high[x], high[y]) - smaller(low[x], low[y]);
      const int at = 4 * cut;
      return box_cost_of(sides[at], sides[at + 1], sides[at + 2]);
    };
    cuts[0].left_cost = cost_of(0, 0, 2), cuts[0].right_cost = cost_of(0, 1, 3);
    cuts[1].left_cost = cost_of(1, 0, 1), cuts[1].right_cost = cost_of(1, 2, 3);
  }

  /// Partitions the orders along the axes into left and right, stably.
  void part(std::uint32_t begin, std::uint32_t end, const Cut& cut) {
    const std::uint8_t* const along = m_.order[cut.axis];
    // The halves are leaves: one order is enough.
    if (end - begin <= 2 * kTreeWidth) {
      if (cut.axis != 0) __builtin_memcpy(m_.order[0] + begin, along + begin, end - begin);
      return;
    }
    for (std::uint32_t i = begin; i < end; ++i) m_.side[along[i]] = i < begin + cut.left;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      if (axis == cut.axis) continue;
      std::uint8_t* const range = m_.order[axis];
      std::uint32_t left = begin, right = 0;
      // Each simplex is written to both sides, and only one of the ends moves: the sides cannot be predicted.
      for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint8_t s = range[i], is_left = m_.side[s];
        range[left] = m_.right[right] = s;
        left += is_left;
        right += 1u - is_left;
      }
      __builtin_memcpy(range + left, m_.right, right);
    }
  }

  void split(std::uint32_t self, std::uint32_t begin, std::uint32_t end, const FloatMoments& all,
             double cost) {
    const std::uint32_t leaves = (end - begin + kTreeWidth - 1) / kTreeWidth;
    k_.nodes[self] = {begin_ + begin, begin_ + end, kNull, kNull, cost};
    if (leaves == 1) return fill_leaf(begin, end);
    const float whole = 1 / all.first[3];
    const Float4 mean = all.first * splat4(whole), spread = all.squares * splat4(whole) - mean * mean;
    if (self_ != self && !(spread[0] + spread[1] + spread[2] >= kSmallVariance)) {
      for (std::uint32_t i = begin; i < end; ++i) k_.order[begin_ + i] = m_.simplex[m_.order[0][i]];
      waiting[waiting_count++] = self;
      return;
    }
    Cut best[2];
    rank(begin, end, all, best);
    fit(begin, end, all, best);
    const auto cost_of = [&](const Cut& cut) {
      const auto count = static_cast<float>(cut.left / kTreeWidth);
      return cut.left_cost * count + cut.right_cost * (static_cast<float>(leaves) - count);
    };
    const Cut& cut = best[cost_of(best[1]) < cost_of(best[0])];
    part(begin, end, cut);
    const double unit = 1 / (to_local_ * to_local_);
    const std::uint32_t left = self + 1, right = left + 2 * (cut.left / kTreeWidth) - 1;
    const double right_cost = static_cast<double>(cut.right_cost) * unit;
    const FloatMoments of_right = all - cut.of_left;
    const std::uint32_t boundary = begin + cut.left;
    k_.nodes[self].left = left, k_.nodes[self].right = right;
    split(left, begin, boundary, cut.of_left, static_cast<double>(cut.left_cost) * unit);
    split(right, boundary, end, of_right, right_cost);
  }

  void fill_leaf(std::uint32_t begin, std::uint32_t end);

  DivideKernel& k_;
  DivideMemory& m_;
  std::uint32_t begin_ = 0, self_ = 0, vertices_ = 0;
  std::uint8_t leaf_ = 0;
  double to_local_ = 1;
};

inline void Division::fill_leaf(std::uint32_t begin, std::uint32_t end) {
  const std::uint32_t count = end - begin, leaf = (begin_ + begin) / kTreeWidth;
  LeafBlock& block = k_.blocks[leaf];
  // The different vertices, and the place of each corner among them. Absent simplices repeat the last one, so
  // that all eight lanes contain valid coordinates.
  std::uint16_t vertex[3 * kTreeWidth];
  std::uint8_t place[3][kTreeWidth];
  std::uint32_t size = 0;
  ++leaf_;
  for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
    const std::uint8_t s = m_.order[0][i < count ? begin + i : end - 1];
    const std::uint32_t listed = m_.simplex[s];
    block.simplex[i] = i < count ? k_.in.simplices[listed] : SimplexId(kNull);
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint16_t v = m_.corner[s][corner];
      if (m_.seen[v] != leaf_) {
        m_.seen[v] = leaf_;
        m_.place[v] = static_cast<std::uint8_t>(size);
        vertex[size++] = v;
      }
      place[corner][i] = m_.place[v];
    }
  }
  Double4 low = load4(m_.position[vertex[0]]), high = low;
  for (std::uint32_t i = 1; i < size; ++i) {
    low = smaller(low, load4(m_.position[vertex[i]]));
    high = larger(high, load4(m_.position[vertex[i]]));
  }
  const Double4 centre = 0.5 * (low + high), side = high - low;
  // Relative coordinates of about 1, so that squares neither overflow nor underflow.
  const double to_one = inverse_power_of_two(longest_of(side));
  Double4 point[3 * kTreeWidth];
  Sample sample;
  sample.count = (size + 7) / 8 * 8;
  for (std::uint32_t i = 0; i < size; ++i) {
    point[i] = (load4(m_.position[vertex[i]]) - centre) * splat4d(to_one);
    for (int j = 0; j < 3; ++j) sample.x[j][i] = static_cast<float>(point[i][j]);
  }
  for (int j = 0; j < 3; ++j)
    for (std::uint32_t i = size; i < sample.count; ++i) sample.x[j][i] = sample.x[j][0];
  // Moments, then relative to the mean.
  const Double4 relative = side * splat4d(to_one), square = relative * relative;
  const double corner_weight = kFrameCornerWeight * (square[0] + square[1] + square[2]);
  Moments<Double4> all;
  for (std::uint32_t i = 0; i < count; ++i)
    all += Moments<Double4>(point[place[0][i]], point[place[1][i]], point[place[2][i]], corner_weight);
  const double share = all.first[3] > 0 ? 1 / all.first[3] : 0;
  const Double4 mean = all.first * splat4d(share), squares = all.squares - all.first * mean,
                products = all.products - all.next(all.first) * all.last(mean);
  double second[6];
  for (int i = 0; i < 3; ++i) second[i] = squares[i], second[3 + i] = products[i];

  // Project the vertices once, in double, and round them to float; the boxes are those of the rounded
  // corners.
  NodeAxes axes(second, sample);
  const double from_one = 1 / to_one;
  Float4 seen[3 * kTreeWidth], box[2];
  const auto project = [&] {
    Double4 column[3];
    for (int j = 0; j < 3; ++j)
      column[j] = Double4{axes.row[0][j], axes.row[1][j], axes.row[2][j], 0} * splat4d(from_one);
    for (std::uint32_t i = 0; i < size; ++i) {
      const Double4 x = splat4d(point[i][0]) * column[0] + splat4d(point[i][1]) * column[1] +
                        splat4d(point[i][2]) * column[2];
      seen[i] = __builtin_convertvector(x, Float4);
    }
    box[0] = box[1] = seen[0];
    for (std::uint32_t i = 1; i < size; ++i)
      box[0] = smaller(box[0], seen[i]), box[1] = larger(box[1], seen[i]);
  };
  project();
  // Principal axes are not always best: those of a cube are arbitrary. Otherwise use the coordinate axes.
  const Float4 turned = box[1] - box[0];
  if (!axes.straight && !(half_area_of(double{turned[0]}, double{turned[1]}, double{turned[2]}) <
                          half_area_of(side[0], side[1], side[2]))) {
    axes.straighten();
    project();
  }
  ChildBoxes boxes;
  for (int corner = 0; corner < 3; ++corner) {
    Float4 rows[8];
    Float8 columns[4];
    for (int i = 0; i < 8; ++i) rows[i] = seen[place[corner][i]];
    transpose(rows, columns);
    __builtin_memcpy(block.corner[corner], columns, sizeof block.corner[corner]);
    for (int i = 0; i < 3; ++i) {
      boxes.low[i] = corner == 0 ? columns[i] : smaller(boxes.low[i], columns[i]);
      boxes.high[i] = corner == 0 ? columns[i] : larger(boxes.high[i], columns[i]);
    }
  }
  const double origin[3] = {centre[0], centre[1], centre[2]};
  TreeNode& node = k_.leaves[leaf];
  quantize(boxes, axes, origin, count, node);
  node.first = leaf;
  node.is_leaf = 1;

  // For the nodes above.
  LeafSum& leaf_sum = k_.sums[leaf];
  NodeSum& sum = leaf_sum.sum;
  const double area = from_one * from_one;
  sum.weight = all.first[3] * area;
  for (int i = 0; i < 3; ++i) {
    sum.mean[i] = centre[i] + mean[i] * from_one;
    sum.second[i] = second[i] * area * area, sum.second[3 + i] = second[3 + i] * area * area;
    sum.low[i] = low[i], sum.high[i] = high[i];
  }
  leaf_sum.packets = m_.packets + k_.packet_count;
  leaf_sum.packet_count = (size + 3) / 4;
  for (std::uint32_t i = 0; i < 4 * leaf_sum.packet_count; ++i) {
    VertexPacket& packet = m_.packets[k_.packet_count + i / 4];
    const double* const x = m_.position[vertex[i < size ? i : size - 1]];
    for (int j = 0; j < 3; ++j) packet.x[j][i % 4] = x[j];
  }
  k_.packet_count += leaf_sum.packet_count;
}

}  // namespace

void LRB_DIVIDE_KERNEL_NAME(DivideKernel& k) {
  k.packet_count = 0;
  Division division(k);
  division.divide(k.self);
  while (division.waiting_count > 0) division.divide(division.waiting[--division.waiting_count]);
}

}  // namespace lrb
