// The structures that the paper's introduction compares the LRB-rep with, in textbook versions. They classify
// the faces of one body into the structure of the other, in doubles.
#include "bench/methods/structures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include <Eigen/Geometry>

#include "bench/methods/triangles.hpp"
#include "engine/mesh/box_tree.hpp"
#include <lrbscope/error.hpp>

namespace lrb::methods {

namespace {

template <class List>
std::size_t size_of(const List& list) {
  return list.size() * sizeof(*list.data());
}

/// Asks a structure, with B's pose in A's frame, and takes the time.
template <class Body>
class Structure : public MethodOf<Body> {
 public:
  using typename MethodOf<Body>::Posed;

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override { return std::make_unique<Body>(rep); }
  Answer ask(const Posed& a, const Posed& b, Mode mode) final {
    Answer answer;
    const Stopwatch watch;
    search(a, b, relative(a.pose, b.pose), mode == Mode::first_pair, answer);
    answer.microseconds = watch.microseconds();
    sort_pairs(answer.pairs);
    return answer;
  }

 protected:
  virtual void search(const Posed& a, const Posed& b, const Pose& b_in_a, bool only_first,
                      Answer& answer) = 0;
};

// Descends two sphere trees together to a given level: an approximate, interruptible answer (P. M. Hubbard,
// "Collision Detection for Interactive Graphics Applications", PhD thesis, Brown University, 1994: the
// paper's Hub94). Spheres contain the triangles below them, so no contact is missed. Overlapping spheres at
// the last level count as contact.

struct Sphere {
  Eigen::Vector3d centre;
  double radius = 0;
};

/// Halved by the centroids of the triangles.
struct SphereBody : SizedBody {
  explicit SphereBody(const LrbRep& rep) {
    const Triangles t = triangles_of(rep);
    std::vector<BoxTree::Box> centroids;
    for (const auto& c : t.triangles)
      centroids.emplace_back(Eigen::Vector3d((t.vertices[c[0]] + t.vertices[c[1]] + t.vertices[c[2]]) / 3));
    tree = BoxTree(centroids, 1);
    for (const BoxTree::Node& n : tree.nodes())
      spheres.push_back(around(t, tree.items().subspan(n.first, n.last - n.first)));
  }

  static Sphere around(const Triangles& t, std::span<const std::uint32_t> some) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t i : some)
      for (const VertexId v : t.triangles[i]) box.extend(t.vertices[v]);
    Sphere s;
    s.centre = box.center();
    for (const std::uint32_t i : some)
      for (const VertexId v : t.triangles[i])
        s.radius = std::max(s.radius, (t.vertices[v] - s.centre).norm());
    return s;
  }

  std::size_t bytes() const override {
    return size_of(tree.nodes()) + size_of(tree.items()) + size_of(spheres);
  }

  BoxTree tree;
  std::vector<Sphere> spheres;  ///< around its nodes
};

class Spheres : public Structure<SphereBody> {
 public:
  void set(double level) override { level_ = static_cast<int>(level); }

  void search(const Posed& a, const Posed& b, const Pose& b_in_a, bool only_first, Answer& answer) override {
    struct Item {
      std::uint32_t a, b;
      int level;
    };
    std::vector<Item> stack = {{0, 0, 0}};
    while (!stack.empty()) {
      const Item item = stack.back();
      stack.pop_back();
      const Sphere &p = a.body.spheres[item.a], &q = b.body.spheres[item.b];
      const Eigen::Vector3d direction = b_in_a.apply(q.centre) - p.centre;
      ++answer.face_tests;
      const double reach = p.radius + q.radius;
      if (direction.squaredNorm() > reach * reach) continue;
      const std::uint32_t right_a = a.body.tree.nodes()[item.a].right,
                          right_b = b.body.tree.nodes()[item.b].right;
      if (item.level >= level_ || (right_a == 0 && right_b == 0)) {
        // On average, the midpoint between the points where the line of centres leaves one sphere and enters
        // the other.
        const double length = direction.norm();
        const double at = length > 0 ? (p.radius + length - q.radius) / (2 * length) : 0;
        answer.points.push_back(a.pose.apply(p.centre + at * direction));
        if (only_first) break;
        continue;
      }
      // A leaf takes the place of its children.
      const std::uint32_t below_a[] = {right_a == 0 ? item.a : item.a + 1, right_a},
                          below_b[] = {right_b == 0 ? item.b : item.b + 1, right_b};
      for (int i = 0; i < (right_a == 0 ? 1 : 2); ++i)
        for (int j = 0; j < (right_b == 0 ? 1 : 2); ++j)
          stack.push_back({below_a[i], below_b[j], item.level + 1});
    }
    answer.contact = !answer.points.empty();
  }

 private:
  int level_ = 0;
};

// B-reps with an index of space: the faces of A are in the cells that they pass through, and each face of B
// is tested against all faces in the cells that its box touches.

/// Halves space across its longest extent until few faces pass through a cell: the Brep-index (MSP tree; G.
/// Vanecek, "Brep-index: a multidimensional space partitioning tree", IJCGA 1(3), 1991: the paper's Van91)
/// with planes along the axes.
class HalvedSpace {
 public:
  explicit HalvedSpace(const std::vector<Box>& boxes) {
    std::vector<std::uint32_t> all(boxes.size());
    std::iota(all.begin(), all.end(), 0U);
    for (const Box& b : boxes) whole_.extend(b);
    halve(boxes, whole_, all, 0);
  }

  /// Calls visit(face) for the faces in all cells that `box` touches, perhaps repeatedly. Returns the number
  /// of cells visited.
  template <class Visit>
  std::uint64_t visit_near(const Box& box, const Visit& visit) const {
    std::uint64_t visited = 0;
    std::vector<std::uint32_t> stack;
    if (BoxTree::intersect(whole_, box)) stack.push_back(0);
    while (!stack.empty()) {
      const std::uint32_t n = stack.back();
      const Node& node = nodes_[n];
      stack.pop_back();
      ++visited;
      if (node.axis == kLeaf) {
        for (std::uint32_t i = node.first; i < node.last; ++i) visit(items_[i]);
        continue;
      }
      if (box.max()[node.axis] >= node.at) stack.push_back(node.high);
      if (box.min()[node.axis] <= node.at) stack.push_back(n + 1);
    }
    return visited;
  }
  std::size_t bytes() const { return size_of(nodes_) + size_of(items_); }

 private:
  static constexpr int kLeaf = 3, kMaxDepth = 30;
  static constexpr std::size_t kFewFaces = 8;
  struct Node {
    double at = 0;
    int axis = kLeaf;
    std::uint32_t high = 0;             ///< the lower half follows its parent
    std::uint32_t first = 0, last = 0;  ///< of a leaf, into items_
  };

  void halve(const std::vector<Box>& boxes, const Box& cell, const std::vector<std::uint32_t>& some,
             int depth) {
    const auto n = static_cast<std::uint32_t>(nodes_.size());
    Node node;
    cell.sizes().maxCoeff(&node.axis);
    node.at = box_centre(cell)[node.axis];
    std::vector<std::uint32_t> low, high;
    for (const std::uint32_t i : some) {
      if (boxes[i].min()[node.axis] <= node.at) low.push_back(i);
      if (boxes[i].max()[node.axis] >= node.at) high.push_back(i);
    }
    // A cut through most of the faces separates nothing.
    if (some.size() <= kFewFaces || depth == kMaxDepth || 2 * (low.size() + high.size()) > 3 * some.size()) {
      node.axis = kLeaf;
      node.first = static_cast<std::uint32_t>(items_.size());
      items_.insert(items_.end(), some.begin(), some.end());
      node.last = static_cast<std::uint32_t>(items_.size());
      nodes_.push_back(node);
      return;
    }
    nodes_.push_back(node);
    Box lower = cell, upper = cell;
    lower.max()[node.axis] = upper.min()[node.axis] = node.at;
    halve(boxes, lower, low, depth + 1);
    nodes_[n].high = static_cast<std::uint32_t>(nodes_.size());
    halve(boxes, upper, high, depth + 1);
  }

  Box whole_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

/// Grids of cells of half the edge from level to level. A face is in one cell of the finest level whose cells
/// are as large as the face, and reaches at most into the next cells (K. M. Fairchild and T. Poston, VRST
/// '94: the paper's FP94).
class Grids {
 public:
  explicit Grids(const std::vector<Box>& boxes) {
    for (const Box& b : boxes) whole_.extend(b);
    const double size = whole_.sizes().maxCoeff();
    for (int l = 0; l < kLevels; ++l) levels_[l].edge = std::ldexp(size, -l);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      int l = 0;
      while (l + 1 < kLevels && levels_[l + 1].edge >= boxes[i].sizes().maxCoeff()) ++l;
      const Eigen::Vector3d at = boxes[i].min();
      levels_[l].cells.emplace_back(key(cell(l, at, 0, 0), cell(l, at, 0, 1), cell(l, at, 0, 2)), i);
    }
    for (Level& level : levels_) std::sort(level.cells.begin(), level.cells.end());
  }

  /// As HalvedSpace::visit_near(); a row of cells counts once.
  template <class Visit>
  std::uint64_t visit_near(const Box& box, const Visit& visit) const {
    std::uint64_t visited = 0;
    if (!BoxTree::intersect(whole_, box)) return visited;
    for (int l = 0; l < kLevels; ++l) {
      const auto& cells = levels_[l].cells;
      if (cells.empty()) continue;
      std::uint64_t low[3], high[3];
      for (int k = 0; k < 3; ++k) {
        low[k] = cell(l, box.min(), -1, k);
        high[k] = cell(l, box.max(), 0, k);
      }
      if ((high[0] - low[0] + 1) * (high[1] - low[1] + 1) >
          cells.size()) {  // all faces of the level are fewer
        ++visited;
        for (const auto& face : cells) visit(face.second);
        continue;
      }
      for (std::uint64_t i = low[0]; i <= high[0]; ++i)
        for (std::uint64_t j = low[1]; j <= high[1]; ++j) {
          ++visited;
          const std::uint64_t last = key(i, j, high[2]);
          auto at = std::lower_bound(cells.begin(), cells.end(), std::pair(key(i, j, low[2]), 0U));
          for (; at != cells.end() && at->first <= last; ++at) visit(at->second);
        }
    }
    return visited;
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Level& level : levels_) sum += size_of(level.cells);
    return sum;
  }

 private:
  static constexpr int kLevels = 10;
  struct Level {
    double edge = 0;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> cells;  ///< by key: a face in it
  };

  static std::uint64_t key(std::uint64_t i, std::uint64_t j, std::uint64_t k) {
    return (i << 2 * kLevels | j << kLevels) | k;
  }
  /// Returns the coordinate of the cell of a point, moved by some cells, within the grid.
  std::uint64_t cell(int level, const Eigen::Vector3d& x, int moved, int axis) const {
    const double c = std::floor((x[axis] - whole_.min()[axis]) / levels_[level].edge) + moved;
    return c > 0 ? static_cast<std::uint64_t>(std::min(c, std::ldexp(1, level) - 1)) : 0;
  }

  Box whole_;
  std::array<Level, kLevels> levels_;
};

template <class Index>
struct IndexedBody : SizedBody {
  explicit IndexedBody(const LrbRep& rep) : faces(triangles_of(rep)), index(boxes_of(faces)) {}
  static std::vector<Box> boxes_of(const Triangles& t) {
    std::vector<Box> boxes(t.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (const VertexId v : t.triangles[i]) boxes[i].extend(t.vertices[v]);
    return boxes;
  }
  std::size_t bytes() const override { return index.bytes(); }
  Triangles faces;
  Index index;
};

template <class Index>
class Indexed : public Structure<IndexedBody<Index>> {
 public:
  using typename Structure<IndexedBody<Index>>::Posed;

  void search(const Posed& a, const Posed& b, const Pose& b_in_a, bool only_first, Answer& answer) override {
    std::vector<std::uint32_t> tested_with(a.body.faces.triangles.size(), kNull);
    cells_ = 0;
    for (std::uint32_t j = 0; j < b.body.faces.triangles.size(); ++j) {
      Box box;
      Eigen::Vector3d q[3];
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d& x = b.body.faces.vertices[b.body.faces.triangles[j][k]];
        box.extend(b_in_a.apply(x));
        q[k] = b.pose.apply(x);
      }
      box.extend((box.min().array() - kUsualEpsilon).matrix())
          .extend((box.max().array() + kUsualEpsilon).matrix());
      cells_ += a.body.index.visit_near(box, [&](std::uint32_t i) {
        if (tested_with[i] == j || (only_first && answer.contact)) return;
        tested_with[i] = j;
        ++answer.face_tests;
        Eigen::Vector3d p[3];
        for (int k = 0; k < 3; ++k) p[k] = a.pose.apply(a.body.faces.vertices[a.body.faces.triangles[i][k]]);
        if (!plain_triangles_meet(p, q)) return;
        answer.contact = true;
        answer.pairs.push_back({SimplexId(i), SimplexId(j)});
      });
      if (only_first && answer.contact) break;
    }
  }

  std::optional<TestCounts> tests_of(const Posed& a, const Posed& b) override {
    const std::uint64_t faces = this->ask(a, b, Mode::all_pairs).face_tests;
    return TestCounts{cells_, faces};
  }

 private:
  std::uint64_t cells_ = 0;  ///< visited by the last query
};

// A BSP tree of A, whose leaves are solid or empty; the faces of B are cut by its planes (B. Naylor, "Binary
// space partitioning trees as an alternative representation of polytopes", CAD 22(4), 1990: the paper's
// Nay90). A face with parts in solid and in empty cells crosses the surface.

struct BspBody : SizedBody {
  using Polygon = std::vector<Eigen::Vector3d>;
  using Plane = Eigen::Hyperplane<double, 3>;
  struct Face {
    Polygon corners;
    Plane plane;
  };
  struct Node {
    Plane plane;
    std::uint32_t front = kEmpty, back = kSolid;
  };
  static constexpr std::uint32_t kEmpty = kNull, kSolid = kNull - 1;

  explicit BspBody(const LrbRep& rep) : faces(triangles_of(rep)) {
    if (!rep.closed()) throw InputError("skipped: a body that is not closed has no solid side");
    std::vector<Face> all;
    for (const auto& c : faces.triangles) {
      const Eigen::Vector3d &p = faces.vertices[c[0]], &q = faces.vertices[c[1]], &r = faces.vertices[c[2]];
      const Eigen::Vector3d normal = (q - p).cross(r - p);
      if (normal.norm() > 0) all.push_back({{p, q, r}, Plane(normal.normalized(), p)});
    }
    root = add(std::move(all), kEmpty);
  }

  /// Returns the parts of a polygon in front of and behind a plane; empty ones if it is in the plane.
  static std::array<Polygon, 2> cut(const Plane& plane, const Polygon& p) {
    std::vector<double> d;
    for (const Eigen::Vector3d& x : p) {
      const double side = plane.signedDistance(x);
      d.push_back(std::abs(side) < kUsualEpsilon ? 0 : side);
    }
    const auto [least, most] = std::minmax_element(d.begin(), d.end());
    std::array<Polygon, 2> parts;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const std::size_t next = (i + 1) % p.size();
      if (d[i] >= 0) parts[0].push_back(p[i]);
      if (d[i] <= 0) parts[1].push_back(p[i]);
      if (d[i] * d[next] >= 0) continue;
      for (Polygon& part : parts) part.push_back(p[i] + (p[next] - p[i]) * (d[i] / (d[i] - d[next])));
    }
    if (*most <= 0) parts[0].clear();
    if (*least >= 0) parts[1].clear();
    return parts;
  }

  /// Returns 1 if a part of the polygon is in an empty cell, 2 in a solid one, 3 both.
  unsigned leaves_of(std::uint32_t n, const Polygon& p, std::uint64_t& tests) const {
    if (n == kEmpty || n == kSolid) return n == kEmpty ? 1 : 2;
    ++tests;
    auto parts = cut(nodes[n].plane, p);
    if (parts[0].empty() && parts[1].empty()) parts = {p, p};  // in the plane: on both sides
    const unsigned front = parts[0].empty() ? 0 : leaves_of(nodes[n].front, parts[0], tests);
    return parts[1].empty() || front == 3 ? front : front | leaves_of(nodes[n].back, parts[1], tests);
  }

  std::size_t bytes() const override { return size_of(nodes); }

  Triangles faces;
  std::vector<Node> nodes;
  std::uint32_t root;

 private:
  /// Adds the subtree of the faces in a cell; returns `leaf` if there are none.
  std::uint32_t add(std::vector<Face> some, std::uint32_t leaf) {
    if (some.empty()) return leaf;
    Plane plane;
    std::array<std::vector<Face>, 2> halves;
    const auto distribute = [&] {
      halves = {};
      for (const Face& f : some) {
        const auto parts = cut(plane, f.corners);
        for (int k = 0; k < 2; ++k)
          if (!parts[k].empty()) halves[k].push_back({parts[k], f.plane});
      }
    };
    // Many faces are halved across an axis first, which keeps the tree low.
    constexpr std::size_t kMany = 32;
    int axis = some.size() < kMany ? 3 : 0;
    for (; axis < 3; ++axis) {
      std::vector<double> at;
      for (const Face& f : some) at.push_back(f.corners[0][axis]);
      std::sort(at.begin(), at.end());
      const auto above = std::upper_bound(at.begin(), at.end(), at[at.size() / 2]);
      if (above == at.end() || *above - *(above - 1) < 4 * kUsualEpsilon) continue;
      plane = Plane(Eigen::Vector3d::Unit(axis), -(*(above - 1) + *above) / 2);
      distribute();
      if (4 * std::max(halves[0].size(), halves[1].size()) < 3 * some.size()) break;
    }
    if (axis == 3) {
      const auto median = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
      plane = median->plane;
      some.erase(median);
      distribute();  // without the faces in the plane
    }
    some = {};
    const auto n = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back({plane});
    const std::uint32_t front = add(std::move(halves[0]), kEmpty), back = add(std::move(halves[1]), kSolid);
    nodes[n] = {plane, front, back};
    return n;
  }
};

class Bsp : public Structure<BspBody> {
 public:
  void search(const Posed& a, const Posed& b, const Pose& b_in_a, bool only_first, Answer& answer) override {
    for (const auto& c : b.body.faces.triangles) {
      BspBody::Polygon face;
      for (const VertexId v : c) face.push_back(b_in_a.apply(b.body.faces.vertices[v]));
      answer.contact |= a.body.leaves_of(a.body.root, face, answer.face_tests) == 3;
      if (only_first && answer.contact) break;
    }
  }
};

}  // namespace

std::vector<MethodEntry> structures_methods() {
  return {
      entry_of<Spheres>(
          {.name = "spheres",
           .title = "sphere tree, stopped at a level",
           .remark =
               "Contact, and points of it: two binary trees of spheres around triangles, descended to a level; spheres "
               "that still overlap there count as contact. Never misses a contact; many false positives.",
           .pairs = false,
           .traits = {Trait::approximate},
           .parameter = "level",
           .settings = {2, 4, 6, 8, 10, 12},
           .style = {"sphere tree, by level", "#1c1e22", "star"},
           .rank = 80}),
      entry_of<Bsp>(
          {.name = "bsp",
           .title = "BSP tree, faces of B classified",
           .remark =
               "Whether a face of B has parts in solid and in empty cells of A's BSP tree, in doubles, epsilon 1e-6. No "
               "pairs, no relation. Supports only closed bodies.",
           .pairs = false,
           .style = {"BSP tree", "#7a4fa3", "rect"},
           .rank = 81}),
      entry_of<Indexed<HalvedSpace>>(
          {.name = "brep-index",
           .title = "B-rep with an index of halved space",
           .remark =
               "Faces of B against those of A in the cells of space that they touch, halved along the axes (as an "
               "MSP tree), by the test of `plain`. No relation.",
           .style = {"B-rep index (MSP)", "#2f7d5b", "rectRot"},
           .rank = 82}),
      entry_of<Indexed<Grids>>(
          {.name = "grids",
           .title = "hierarchical grid",
           .remark =
               "Faces of B against those of A in the cells of grids that they touch, each face in the grid of its "
               "size, by the test of `plain`. No relation.",
           .style = {"hierarchical grid", "#b0702a", "rectRotOpen"},
           .rank = 83})};
}

}  // namespace lrb::methods
