// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_NODE_KERNEL_NAME. The boxes of
// a node's children are those of the vertices beneath them: a box of a box would be looser.

#include "engine/tree/kernel_frames.inl"

namespace lrb {
namespace {

/// Calls visit(packet) for every `stride`-th one of some leaves.
template <class Visit>
void for_each_packet(const LeafSum* begin, const LeafSum* end, std::uint32_t stride, Visit visit) {
  std::uint32_t skipped = 0;
  for (const LeafSum* leaf = begin; leaf != end; ++leaf)
    for (std::uint32_t i = skipped;; i += stride) {
      if (i >= leaf->packet_count) {
        skipped = i - leaf->packet_count;
        break;
      }
      visit(leaf->packets[i]);
    }
}

}  // namespace

void LRB_NODE_KERNEL_NAME(const NodeKernel& k) {
  double origin[3], side[3];
  for (int i = 0; i < 3; ++i) {
    origin[i] = 0.5 * (k.sum->low[i] + k.sum->high[i]);
    side[i] = k.sum->high[i] - k.sum->low[i];
  }
  // Some of the vertices, relative to the origin and scaled to about 1.
  constexpr std::uint32_t kPackets = 32;
  const LeafSum *const begin = k.children[0].begin, *const end = k.children[k.count - 1].end;
  std::uint32_t packets = 0;
  for (const LeafSum* leaf = begin; leaf != end; ++leaf) packets += leaf->packet_count;
  const Double4 to_one = splat4d(inverse_power_of_two(longest_of(Double4{side[0], side[1], side[2], 0})));
  Sample sample;
  sample.count = 0;
  for_each_packet(begin, end, packets > kPackets ? packets / kPackets : 1, [&](const VertexPacket& packet) {
    for (int i = 0; i < 3; ++i) {
      const Float4 x = __builtin_convertvector(
          (*reinterpret_cast<const Double4*>(packet.x[i]) - splat4d(origin[i])) * to_one, Float4);
      __builtin_memcpy(sample.x[i] + sample.count, &x, sizeof x);
    }
    sample.count += 4;
  });
  // Repeat the last ones.
  for (int i = 0; sample.count % 8 != 0 && i < 3; ++i)
    __builtin_memcpy(sample.x[i] + sample.count, sample.x[i] + sample.count - 4, sizeof(Float4));
  sample.count = (sample.count + 7) / 8 * 8;

  NodeAxes axes(k.sum->second, sample);
  ChildBoxes boxes;
  const auto set = [&](std::uint32_t child, int axis, double low, double high) {
    // Absent children repeat the last one.
    for (std::uint32_t i = child; i < (child + 1 == k.count ? kTreeWidth : child + 1); ++i) {
      boxes.low[axis][i] = static_cast<float>(low);
      boxes.high[axis][i] = static_cast<float>(high);
    }
  };
  double low[3], high[3];
  for (int i = 0; i < 3; ++i) low[i] = __builtin_inf(), high[i] = -low[i];
  for (std::uint32_t child = 0; child < k.count; ++child) {
    Double4 lowest[3], highest[3];
    for (int i = 0; i < 3; ++i) lowest[i] = splat4d(__builtin_inf()), highest[i] = -lowest[i];
    for_each_packet(k.children[child].begin, k.children[child].end, 1, [&](const VertexPacket& packet) {
      Double4 x[3];
      for (int i = 0; i < 3; ++i) x[i] = *reinterpret_cast<const Double4*>(packet.x[i]) - splat4d(origin[i]);
      for (int i = 0; i < 3; ++i) {
        const Double4 y =
            splat4d(axes.row[i][0]) * x[0] + splat4d(axes.row[i][1]) * x[1] + splat4d(axes.row[i][2]) * x[2];
        lowest[i] = smaller(lowest[i], y);
        highest[i] = larger(highest[i], y);
      }
    });
    for (int i = 0; i < 3; ++i) {
      double least = lowest[i][0], most = highest[i][0];
      for (int lane = 1; lane < 4; ++lane) {
        least = lowest[i][lane] < least ? lowest[i][lane] : least;
        most = highest[i][lane] > most ? highest[i][lane] : most;
      }
      set(child, i, least, most);
      low[i] = least < low[i] ? least : low[i];
      high[i] = most > high[i] ? most : high[i];
    }
  }
  // Principal axes are not always best: those of a cube are arbitrary. Otherwise use the coordinate axes.
  if (!axes.straight && !(half_area_of(high[0] - low[0], high[1] - low[1], high[2] - low[2]) <
                          half_area_of(side[0], side[1], side[2]))) {
    axes.straighten();
    for (std::uint32_t child = 0; child < k.count; ++child)
      for (int i = 0; i < 3; ++i)
        set(child, i, k.children[child].sum->low[i] - origin[i], k.children[child].sum->high[i] - origin[i]);
  }
  quantize(boxes, axes, origin, k.count, *k.node);
}

}  // namespace lrb
