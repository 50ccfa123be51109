#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/bodies/generators.hpp"
#include <lrbscope/core/random.hpp>
#include <lrbscope/error.hpp>

namespace lrb::generators {
namespace {

using Eigen::Vector3d;
using Point = Eigen::Matrix<std::int64_t, 3, 1>;

// Coordinates are integers, with 2^kUnitBits per unit of length. Those of the basic shape are multiples of
// 2^-5; each level of detail uses weights in sixteenths, that is, four more bits.
constexpr int kUnitBits = 46, kBaseBits = 5, kLevelBits = 4;
constexpr int kMaxLevel = (kUnitBits - kBaseBits) / kLevelBits;

// Share of the available angle at an edge that one dent takes; the rest is for the dents in its walls.
constexpr double kShare = 0.35;
// Maximum angle by which a dent undercuts its neighbours, however large the available angle is (radians).
constexpr double kMaxRoom = 75 * std::numbers::pi / 180;
constexpr double kWallRoom = 30 * std::numbers::pi / 180;
constexpr double kSteepest = 60 * std::numbers::pi / 180;

// Unevenness of detail: in the order of dents, a face counts as if it were wider or narrower by up to this
// many powers of two.
constexpr double kUneven = 2.5;
constexpr double kFirst = 1e6;  ///< more than any width

struct Polygon {
  std::vector<VertexId> corners;  ///< counter-clockwise seen from outside
  /// Angle between the face and the part of the solid available to it, at edge (i, i + 1).
  std::vector<double> room;
  CellId inner = kSolid, outer = kOutside;
  int level = 0;
};

/// A kind of dent: the geometry behind a lid with m corners.
struct Kind {
  bool rim;    ///< there is a coplanar frame around the dent proper
  bool flush;  ///< the rim and the inner lid form a separate region without volume
  bool flat;   ///< a frustum with a flat bottom; else a pyramid
  int lids() const { return flush ? 2 : 1; }
  /// Returns the number of real faces that it adds.
  int gain(int m) const { return m - 1 + (flat ? 1 : 0) + (rim ? m : 0); }
};

constexpr std::array<Kind, 6> kKinds = {Kind{false, false, false}, Kind{false, false, true},
                                        Kind{true, false, false},  Kind{true, false, true},
                                        Kind{true, true, false},   Kind{true, true, true}};

class Carver {
 public:
  explicit Carver(const FractalSpec& spec) : spec_(spec), random_(spec.seed) { start(); }

  LrbRep run() {
    const auto real =
        std::count_if(faces_.begin(), faces_.end(), [](const Polygon& f) { return f.inner == kSolid; });
    const auto lids = static_cast<std::int64_t>(faces_.size()) - real;
    lids_left_ = static_cast<std::int64_t>(spec_.total_faces) - spec_.real_faces - lids;
    gain_left_ = static_cast<std::int64_t>(spec_.real_faces) - real;
    if (spec_.total_faces < spec_.real_faces || !fits(lids_left_, gain_left_))
      throw InputError("fractal body: no dents make " + std::to_string(spec_.real_faces) + " real faces of " +
                       std::to_string(spec_.total_faces) + "; expected real_faces - " + std::to_string(real) +
                       " to be 2.5 to 7 times the number of pseudo faces (total_faces - real_faces)" +
                       (lids > 0 ? " without the " + std::to_string(lids) + " outermost" : ""));
    while (lids_left_ > 0) carve_next();
    return LrbRep(data());
  }

 private:
  /// Makes the basic shape. Its edges limit the dents of their faces.
  void start() {
    spec_.outer_faces == 7 ? start_prism() : start_star();
    // Each edge may use half of the angle of the solid between its two faces. At a reflex edge that is more
    // than a right angle.
    for (Polygon& f : faces_)
      for (std::size_t i = 0; f.inner == kSolid && i < f.corners.size(); ++i)
        for (const Polygon& g : faces_)
          if (g.inner == kSolid && has_edge(g, f.corners[(i + 1) % f.corners.size()], f.corners[i])) {
            const double turn = deterministic::acos(normal(f).dot(normal(g)));
            const bool reflex = normal(f).dot(centre(g) - position(f.corners[i])) > 0;
            f.room.push_back(std::min((std::numbers::pi + (reflex ? turn : -turn)) / 2, kMaxRoom));
          }
  }

  /// A pentagonal prism, lying on its side like a house.
  void start_prism() {
    const std::array<Eigen::Vector2d, 5> house = {{{-1, -0.75}, {1, -0.75}, {1, 0.25}, {0, 1}, {-1, 0.25}}};
    for (const double z : {-0.875, 0.875})
      for (const auto& p : house) points_.push_back(on_grid({p.x(), p.y(), z}, 0));
    add({4, 3, 2, 1, 0}, {}, kOutside, 0);
    add({5, 6, 7, 8, 9}, {}, kOutside, 0);
    for (VertexId i = 0; i < 5; ++i) {
      const VertexId j((i + 1) % 5);
      add({i, j, VertexId(j + 5), VertexId(i + 5)}, {}, kOutside, 0);
    }
  }

  /// The stella octangula: an octahedron with a tetrahedron on each face, whose tips are the corners of a
  /// cube. The faces of the cube are the lids of the first region; the 24 faces of the star are its floor.
  void start_star() {
    regions_ = 1;
    for (int k = 0; k < 3; ++k)  // vertices 2 k and 2 k + 1: the ends of axis k of the octahedron
      for (const double end : {-1.0, 1.0}) points_.push_back(on_grid(end * Vector3d::Unit(k), 0));
    for (int c = 0; c < 8; ++c) {
      const int positive[3] = {c & 1, c >> 1 & 1, c >> 2 & 1};
      const VertexId tip =
          new_vertex(on_grid({2.0 * positive[0] - 1, 2.0 * positive[1] - 1, 2.0 * positive[2] - 1}, 0));
      const bool mirrored = (positive[0] + positive[1] + positive[2]) % 2 == 0;
      for (int k = 0; k < 3; ++k) {
        VertexId from(2 * k + positive[k]), to(2 * ((k + 1) % 3) + positive[(k + 1) % 3]);
        if (mirrored) std::swap(from, to);
        add({tip, from, to}, {}, RegionId(0), 0);
      }
    }
    constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& side : kSides) {
      Polygon lid{{}, {}, RegionId(0), kOutside, 0};
      for (const int corner : side) lid.corners.emplace_back(6 + corner);
      faces_.push_back(std::move(lid));
    }
  }

  static bool has_edge(const Polygon& f, VertexId a, VertexId b) {
    for (std::size_t i = 0; i < f.corners.size(); ++i)
      if (f.corners[i] == a && f.corners[(i + 1) % f.corners.size()] == b) return true;
    return false;
  }

  static std::int64_t grid(int level) {
    return std::int64_t{1} << (kUnitBits - kBaseBits - kLevelBits * level);
  }
  static Point on_grid(const Vector3d& x, int level) {
    const auto g = static_cast<double>(grid(level));
    Point p;
    for (int k = 0; k < 3; ++k) p[k] = std::llround(x[k] * 0x1p46 / g) * grid(level);
    return p;
  }
  static Vector3d position(const Point& p) { return p.cast<double>() * 0x1p-46; }
  Vector3d position(VertexId v) const { return position(points_[v]); }
  VertexId new_vertex(const Point& p) {
    points_.push_back(p);
    return static_cast<VertexId>(points_.size() - 1);
  }

  Vector3d normal(const Polygon& f) const {
    Vector3d n = Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < f.corners.size(); ++i)
      n += (position(f.corners[i]) - position(f.corners[0]))
               .cross(position(f.corners[i + 1]) - position(f.corners[0]));
    return n.normalized();
  }

  /// Returns the distances of the vertex centroid from the edges.
  std::vector<double> distances(const Polygon& f) const {
    const std::size_t m = f.corners.size();
    const Vector3d c = centre(f);
    std::vector<double> out;
    for (std::size_t i = 0; i < m; ++i) {
      const Vector3d p = position(f.corners[i]), along = (position(f.corners[(i + 1) % m]) - p).normalized();
      out.push_back((c - p).cross(along).norm());
    }
    return out;
  }
  Vector3d centre(const Polygon& f) const {
    Vector3d sum = Vector3d::Zero();
    for (const VertexId v : f.corners) sum += position(v);
    return sum / static_cast<double>(f.corners.size());
  }
  double breadth(const Polygon& f) const {
    const std::vector<double> d = distances(f);
    return *std::min_element(d.begin(), d.end());
  }

  /// Adds a face and puts it in the queue for dents. Wide faces come first: slivers are left unchanged. Each
  /// face of the star gets a dent before any detail does.
  void add(std::vector<VertexId> corners, std::vector<double> room, CellId outer, int level) {
    faces_.push_back({std::move(corners), std::move(room), kSolid, outer, level});
    const auto f = static_cast<FaceId>(faces_.size() - 1);
    const double first = level == 0 && is_region(outer) ? kFirst : 0;
    waiting_.push({breadth(faces_[f]) * deterministic::exp2(random_.in(-kUneven, kUneven)) + first, f});
  }

  /// Returns true if some set of dents can add up to these numbers. Keeps a margin while many dents remain;
  /// at the end none is needed.
  static bool fits(std::int64_t lids, std::int64_t gain) {
    if (lids < 0 || gain < 0) return false;
    if (lids == 0) return gain == 0;
    if (lids <= 2) return gain >= 2 * lids && gain <= 8 * lids;
    return 2 * gain >= 5 * lids && gain <= 7 * lids;
  }

  /// Dents a large face so that the remaining numbers still fit.
  void carve_next() {
    std::vector<std::pair<double, FaceId>> passed_over;
    bool done = false;
    while (!done) {
      if (waiting_.empty())
        throw InputError("fractal body: the faces are too small for the grid; request fewer");
      const auto [size, f] = waiting_.top();
      waiting_.pop();
      done = carve(f);
      if (!done && faces_[f].level < kMaxLevel) passed_over.emplace_back(size, f);
    }
    for (const auto& w : passed_over) waiting_.push(w);
  }

  bool carve(FaceId f) {
    if (faces_[f].level >= kMaxLevel) return false;
    const int m = static_cast<int>(faces_[f].corners.size());
    const double wanted = static_cast<double>(gain_left_) / static_cast<double>(lids_left_);
    std::vector<std::pair<double, const Kind*>>
        choice;  // (weight, kind): kinds near the average are more likely
    double sum = 0;
    for (const Kind& k : kKinds) {
      if (!fits(lids_left_ - k.lids(), gain_left_ - k.gain(m))) continue;
      const double deviation = static_cast<double>(k.gain(m)) / k.lids() - wanted;
      sum += deterministic::exp(-deviation * deviation / 2) + 1e-3;
      choice.emplace_back(sum, &k);
    }
    if (choice.empty()) return false;
    const double drawn = random_.in(0, sum);
    const Kind& kind = *std::find_if(choice.begin(), choice.end() - 1, [&](const auto& c) {
                          return drawn < c.first;
                        })->second;
    dent(f, kind);
    lids_left_ -= kind.lids();
    gain_left_ -= kind.gain(m);
    return true;
  }

  /// Shrinks the face about its m corners' centroid to 1 - m u / 16 of its size. Every corner moves by u / 16
  /// of its distance to each of the others: integers stay integers, and the plane is unchanged.
  std::vector<Point> shrunk(const Polygon& f, int u) const {
    Point sum = Point::Zero();
    for (const VertexId v : f.corners) sum += points_[v];
    std::vector<Point> out;
    for (const VertexId v : f.corners) {
      const Point to_all = sum - static_cast<std::int64_t>(f.corners.size()) * points_[v];
      out.push_back(points_[v] + u * (to_all / 16));
    }
    return out;
  }

  std::vector<VertexId> new_vertices(const std::vector<Point>& points, const Point& by) {
    std::vector<VertexId> out;
    for (const Point& p : points) out.push_back(new_vertex(p + by));
    return out;
  }

  void dent(FaceId f, const Kind& kind);
  LrbData data() const;

  const FractalSpec& spec_;
  Random random_;
  std::vector<Point> points_;
  std::vector<Polygon> faces_;
  std::priority_queue<std::pair<double, FaceId>> waiting_;
  std::int64_t lids_left_ = 0, gain_left_ = 0;
  std::uint32_t regions_ = 0;
};

/// Maximum depth of a dent, and the slope of its walls then.
struct Slope {
  double depth;
  std::vector<double> angle;  ///< between face and wall, at each edge
};

/// Returns the shape of a dent. `rim` and `floor`: distances of the tops and feet of its walls from the
/// edges, as shares of the distance from edge to centre.
Slope slope_of(const std::vector<double>& distance, const std::vector<double>& room, double rim,
               double floor) {
  Slope s{std::numeric_limits<double>::infinity(), {}};
  for (std::size_t i = 0; i < room.size(); ++i) {
    s.depth = std::min(s.depth, floor * distance[i] * deterministic::tan(kShare * room[i]));
    s.depth = std::min(s.depth, (floor - rim) * distance[i] * deterministic::tan(kSteepest));
  }
  for (const double d : distance) s.angle.push_back(deterministic::atan(s.depth / ((floor - rim) * d)));
  return s;
}

void Carver::dent(FaceId index, const Kind& kind) {
  const Polygon f = faces_[index];
  const std::size_t m = f.corners.size();
  const int level = f.level + 1;
  const Vector3d n = normal(f);
  const std::vector<double> distance = distances(f);
  const int rim = kind.rim ? 1 : 0;
  const int foot = m == 5 ? 2 : 2 + static_cast<int>(random_.bits() % 2);
  const auto share = [m](int u) { return static_cast<double>(u) * static_cast<double>(m) / 16; };
  Slope slope = slope_of(distance, f.room, share(rim), kind.flat ? share(foot) : 1);

  RegionId region(regions_++);
  faces_[index].inner = region;
  std::vector<VertexId> top = f.corners;
  std::vector<double> top_room;
  for (std::size_t i = 0; i < m; ++i) top_room.push_back(std::max(0.0, f.room[i] - slope.angle[i]));
  if (kind.rim) {
    top = new_vertices(shrunk(f, rim), Point::Zero());
    for (std::size_t i = 0; i < m; ++i) {
      const std::size_t j = (i + 1) % m;
      const double under = 0.9 * (std::numbers::pi - slope.angle[i]) / 2;
      add({f.corners[i], f.corners[j], top[j], top[i]},
          {f.room[i], kMaxRoom, std::min(under, kMaxRoom), kMaxRoom}, region, level);
      top_room[i] = std::min(under, kWallRoom);
    }
    if (kind.flush) {
      faces_.push_back({top, {}, RegionId(regions_), region, level});
      region = RegionId(regions_++);
    }
  }
  if (kind.flat) {
    const std::vector<VertexId> feet = new_vertices(shrunk(f, foot), on_grid(-slope.depth * n, level));
    for (std::size_t i = 0; i < m; ++i) {
      const std::size_t j = (i + 1) % m;
      add({top[i], top[j], feet[j], feet[i]}, {top_room[i], kMaxRoom, kWallRoom, kMaxRoom}, region, level);
    }
    std::vector<double> room;
    for (const double r : f.room) room.push_back(std::min(r, kMaxRoom));
    add(feet, room, region, level);
  } else {
    const VertexId apex = new_vertex(on_grid(centre(f) - slope.depth * n, level));
    for (std::size_t i = 0; i < m; ++i)
      add({top[i], top[(i + 1) % m], apex}, {top_room[i], kMaxRoom, kMaxRoom}, region, level);
  }
}

LrbData Carver::data() const {
  LrbData d;
  d.name = spec_.name;
  d.closed = true;
  for (const Point& p : points_) d.vertices.push_back(position(p));
  // A region is made before the regions inside it, so that layers can be counted backward from the last one.
  d.region_layer.assign(regions_, 0);
  for (std::size_t f = faces_.size(); f-- > 0;)
    if (is_region(faces_[f].inner) && is_region(faces_[f].outer))
      d.region_layer[faces_[f].outer] =
          std::max<std::uint16_t>(d.region_layer[faces_[f].outer], d.region_layer[faces_[f].inner] + 1);
  for (const bool real : {true, false}) {
    for (const Polygon& f : faces_) {
      if ((f.inner == kSolid) != real) continue;
      d.face_vertices.insert(d.face_vertices.end(), f.corners.begin(), f.corners.end());
      d.face_offsets.push_back(static_cast<std::uint32_t>(d.face_vertices.size()));
      d.inner_cell.push_back(f.inner);
      d.outer_cell.push_back(f.outer);
    }
    if (real) d.real_face_count = static_cast<std::uint32_t>(d.face_count());
  }
  return d;
}

}  // namespace

LrbRep fractal_body(const FractalSpec& spec) {
  return Carver(spec).run();
}

std::span<const FractalSpec> paper_objects() {
  static const std::array<FractalSpec, 8> objects = {{{"A", 34474, 43396, 1, 6},
                                                      {"B", 144, 168, 2, 6},
                                                      {"C", 214, 282, 3, 6},
                                                      {"D", 2004, 2532, 4, 6},
                                                      {"E", 3659, 4463, 5, 6},
                                                      {"F", 10534, 13224, 6, 6},
                                                      {"G", 20719, 25233, 7, 6},
                                                      {"H", 34474, 43396, 8, 6}}};
  return objects;
}

LrbRep fractal_rep(const GeneratorValues& v, std::uint64_t seed) {
  FractalSpec spec;
  spec.real_faces = static_cast<std::uint32_t>(v.at("real_faces"));
  spec.total_faces = static_cast<std::uint32_t>(v.at("total_faces"));
  spec.outer_faces = static_cast<std::uint32_t>(v.at("outer_faces"));
  spec.seed = seed;
  return fractal_body(spec);
}

/// Returns the body's real faces, without the vertices that only lids use.
Mesh fractal(const GeneratorValues& v, std::uint64_t seed) {
  const LrbRep rep = fractal_rep(v, seed);
  Mesh mesh;
  std::vector<VertexId> renumbered(rep.vertices().size(), kNull);
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    std::vector<VertexId> corners;
    for (const VertexId x : rep.face(f)) {
      if (renumbered[x] == kNull) {
        renumbered[x] = static_cast<VertexId>(mesh.vertices.size());
        mesh.vertices.push_back(rep.vertices()[x]);
      }
      corners.push_back(renumbered[x]);
    }
    mesh.add_face(corners);
  }
  return mesh;
}

}  // namespace lrb::generators
