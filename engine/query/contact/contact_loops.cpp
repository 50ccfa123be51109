#include "engine/query/contact/contact_loops.hpp"

#include <map>

namespace lrb {
namespace {

class Chainer {
 public:
  Chainer(std::span<const std::array<std::uint32_t, 2>> edges, const std::vector<Eigen::Vector3d>& points)
      : edges_(edges), points_(points), used_(edges.size(), false) {
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      for (const std::uint32_t p : edges[e]) edges_at_[p].push_back(e);
  }

  std::vector<ContactLoop> run() {
    std::vector<ContactLoop> loops;
    // Follow open chains first, from their ends. Only closed ones are left then.
    for (const auto& [p, at] : edges_at_)
      for (const std::uint32_t e : at)
        if (at.size() != 2 && !used_[e]) loops.push_back(walk(p, e));
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      if (!used_[e]) loops.push_back(walk(edges_[e][0], e));
    return loops;
  }

 private:
  ContactLoop walk(std::uint32_t from, std::uint32_t edge) {
    ContactLoop loop;
    loop.points.push_back(points_[from]);
    std::uint32_t p = from;
    while (true) {
      used_[edge] = true;
      // Go to the other end of the edge.
      p = edges_[edge][0] == p ? edges_[edge][1] : edges_[edge][0];
      const auto& at = edges_at_.at(p);
      loop.closed = p == from;
      if (loop.closed) break;
      loop.points.push_back(points_[p]);
      // An end or a branch point: the chain is open.
      if (at.size() != 2) break;
      // Two edges meet here: leave by the one that is unused.
      edge = used_[at[0]] ? at[1] : at[0];
    }
    return loop;
  }

  std::span<const std::array<std::uint32_t, 2>> edges_;
  const std::vector<Eigen::Vector3d>& points_;
  std::vector<bool> used_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> edges_at_;
};

}  // namespace

std::vector<ContactLoop> chain_edges(std::span<const std::array<std::uint32_t, 2>> edges,
                                     const std::vector<Eigen::Vector3d>& points) {
  return Chainer(edges, points).run();
}

}  // namespace lrb
