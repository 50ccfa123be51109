#include "engine/lrb/real_neighbours.hpp"

#include <algorithm>
#include <cstdint>

namespace lrb {
namespace {

struct Border {
  std::uint64_t key;  ///< its vertices, the smaller one first
  SimplexId simplex;
  std::uint32_t which;
  bool operator<(const Border& other) const {
    return key != other.key ? key < other.key : simplex < other.simplex;
  }
};

}  // namespace

std::vector<Across> real_neighbours(const LrbRep& rep) {
  const auto corners = static_cast<std::uint32_t>(rep.simplex_size());
  std::vector<Border> borders;
  borders.reserve(std::size_t{corners} * rep.real_simplex_count());
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    for (std::uint32_t e = 0; e < corners; ++e) {
      // Key of the border: both vertices, regardless of direction. In 2D a border is one vertex, taken twice.
      const VertexId from = v[e], to = corners == 3 ? v[(e + 1) % 3] : v[e];
      const std::uint64_t low = std::min(from, to).value(), high = std::max(from, to).value();
      borders.push_back({low << 32 | high, s, e});
    }
  }
  // Simplices at the same border become adjacent in the list.
  std::sort(borders.begin(), borders.end());
  std::vector<Across> out(rep.real_simplex_count(), Across{kNull, kNull, kNull});
  for (std::size_t begin = 0, end = 0; begin < borders.size(); begin = end) {
    while (end < borders.size() && borders[end].key == borders[begin].key) ++end;
    // Link each group in a cycle. On a manifold surface a group is a pair, and the two simplices get each
    // other.
    for (std::size_t i = begin; i < end && end - begin > 1; ++i) {
      const Border& next = borders[i + 1 < end ? i + 1 : begin];
      out[borders[i].simplex][borders[i].which] = next.simplex;
    }
  }
  return out;
}

}  // namespace lrb
