#pragma once
/// A capture: a record of another engine's collision queries, made with lrbscope_capture.h. The
/// meshes and trees of the engine, and for each query its poses, the tests in the engine's order, and its
/// answer.
///
///   const capture::Capture c = capture::read_capture("run.lrbcap");
///   for (const capture::Query& q : c.queries)
///     for (const capture::Event& e : q.events) ...
///
/// docs/capture.md describes the file byte by byte.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::capture {

/// A triangle mesh as the engine reported it. It need not be closed, and its triangles may be degenerate.
struct Mesh {
  std::string name;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices, in range
};

/// Kind of bounding volume, with its numbers in the frame of the mesh.
enum class VolumeKind : std::uint32_t {
  aabb = 1,    ///< 6: least x, y, z; greatest x, y, z
  sphere = 2,  ///< 4: centre, radius
  obb = 3,     ///< 12: centre, then three half axes (orthogonal)
  rss = 4,     ///< 10: a corner of the rectangle, its two sides as vectors, radius
  kdop = 5,    ///< 2k: for each direction the least and the greatest product with it
};

/// A body in a tree of instances: its nodes and triangles have consecutive numbers from these on.
struct Instance {
  std::uint32_t tree = 0;  ///< of the body: an index in Capture::trees
  std::uint32_t first_node = 0, first_triangle = 0;
};

/// A tree of bounding volumes as the engine reported it. Nodes are numbered from 0, the root, in the order of
/// the description; events are converted to these numbers. Indices of children are in range, but nothing else
/// is guaranteed: a node may have two parents or none, and a leaf may contain triangles that do not exist.
///
/// A tree of instances contains the trees of its bodies: their roots are children of its leaves, and their
/// volumes are moved, so that boxes become OBBs and spheres may become RSS. Its mesh contains the moved
/// meshes.
struct Tree {
  std::uint32_t id = 0;            ///< the engine's number of the tree
  std::uint32_t mesh = 0;          ///< index in Capture::meshes
  std::uint32_t replaces = kNull;  ///< index in Capture::trees of the tree that this one refits; kNull: none
  VolumeKind volume = VolumeKind::aabb;
  /// With spatial splits: a triangle may be in several leaves, and the volumes of each contain a part of it.
  bool splits = false;
  std::vector<std::uint32_t> first_child, child;        ///< children of node n: child[first_child[n] ..)
  std::vector<std::uint32_t> first_triangle, triangle;  ///< triangles of leaf n, in the same form
  std::vector<double> volumes;                          ///< numbers() for each node, finite
  std::vector<Eigen::Vector3d> directions;              ///< of a k-DOP
  std::vector<std::uint32_t> ids;   ///< the engine's own number of each node; empty: equal to ours
  std::vector<Instance> instances;  ///< of a tree of instances, else empty

  std::size_t size() const { return first_child.size() - 1; }
  std::span<const std::uint32_t> children(std::uint32_t node) const {
    return {child.data() + first_child[node], child.data() + first_child[node + 1]};
  }
  std::span<const std::uint32_t> triangles(std::uint32_t node) const {
    return {triangle.data() + first_triangle[node], triangle.data() + first_triangle[node + 1]};
  }
  bool is_leaf(std::uint32_t node) const { return children(node).empty(); }
  /// Returns the number of doubles per volume.
  std::size_t numbers() const;
  std::span<const double> volume_of(std::uint32_t node) const {
    return std::span(volumes).subspan(node * numbers(), numbers());
  }
  /// Returns the number by which the engine knows the node.
  std::uint32_t id_of(std::uint32_t node) const { return ids.empty() ? node : ids[node]; }
  /// Returns the engine's name of a node or of a triangle: "5", or "5 of instance 2".
  std::string name_of_node(std::uint32_t node) const;
  std::string name_of_triangle(std::uint32_t t) const;
};

// The kind of a query, and the engine's own answer, as in traces.
using QueryKind = trace::EngineQuery;
using Verdict = trace::EngineVerdict;

/// A shape of the world instead of B, in a query of one tree. Events name it by the node and the triangle 0.
enum class ProbeShape : std::uint32_t {
  none = 0,   ///< B is a body
  ray = 1,    ///< 8 numbers: origin, direction, its least and its greatest multiple, which may be infinite
  point = 2,  ///< 3: x, y, z
  box = 3,    ///< 6: least x, y, z; greatest x, y, z; a solid
};
constexpr auto enum_names(ProbeShape) {
  return std::to_array<EnumName<ProbeShape>>({{ProbeShape::none, "body"},
                                              {ProbeShape::ray, "ray"},
                                              {ProbeShape::point, "point"},
                                              {ProbeShape::box, "box"}});
}
struct Probe {
  ProbeShape shape = ProbeShape::none;
  std::array<double, 8> numbers{};
};
/// Returns the pose of a frame in which a ray begins at the origin along x, and a point is the origin; the
/// identity for a box. A direction of length 1, within 1e-6, stays as it is, so that x goes exactly along the
/// ray; others are normalised.
Pose pose_of(const Probe& probe);

enum class EventKind : std::uint8_t {
  nodes = 0,      ///< bounding volumes of node a of tree A and node b of tree B were tested
  triangles = 1,  ///< triangle a of mesh A and triangle b of mesh B were tested
  count = 2,      ///< counter Capture::names[a] of the engine, with value b
  phase = 3,      ///< phase Capture::names[a] of the engine begins
};
/// Axis of an event without a reported axis. Others: 0-2 axes of A, 3-5 axes of B, 6-14 cross products of
/// edges (6 + 3 i + j), 32 + k direction k of a k-DOP.
inline constexpr std::uint8_t kNoAxis = 255;

struct Event {
  std::uint32_t a = 0, b = 0;
  EventKind kind = EventKind::nodes;
  std::uint8_t met = 0;    ///< number of tests with overlap; 0: the engine goes no further here
  std::uint8_t tests = 1;  ///< number of tests: more than 1 for wide nodes
  std::uint8_t axis = kNoAxis;

  friend bool operator==(const Event&, const Event&) = default;
};

/// The events of one thread in a query.
struct Part {
  std::uint32_t thread = 0;
  std::size_t first = 0, count = 0;  ///< in Query::events
};

struct Query {
  std::uint32_t number = 0;  ///< 1, 2, ... in the order of their beginnings
  QueryKind kind = QueryKind::all_pairs;
  /// Indices in Capture::trees; kNull: a single triangle or shape (events then name no node of this side).
  std::array<std::uint32_t, 2> trees{kNull, kNull};
  std::array<Pose, 2> poses;  ///< of A and B: rigid, within 1e-6; of a probe its pose_of()
  Probe probe;                ///< unless it is none, it is B, and B has no tree
  std::uint32_t thread = 0;   ///< that began it
  double begin_ns = 0;        ///< since the capture began
  double duration_ns = 0;     ///< 0 if the capture was cut off before the end
  bool ended = false;         ///< false: the capture was cut off before the end
  Verdict verdict = Verdict::unreported;
  std::uint64_t pairs = 0;  ///< the number of pairs that the engine found, by its own count
  std::optional<std::array<double, 2>> value;  ///< of kind distance: the engine's bounds of the distance
  std::uint64_t events_seen = 0;  ///< by the thread that began it; more than stored if events were not kept
  std::vector<Event> events;      ///< by thread, each in the engine's order
  std::vector<Part> parts;        ///< the first is that of `thread`; a helper has one each time it joined

  /// Returns true if all events of the query are stored.
  bool complete() const { return ended && events_seen == (parts.empty() ? 0 : parts.front().count); }
};

struct Capture {
  std::string engine;              ///< "FCL 0.7.0, BVHModel<OBBRSS>"
  std::vector<std::string> names;  ///< of counters and phases
  std::vector<Mesh> meshes;
  std::vector<Tree> trees;
  std::vector<Query> queries;  ///< by number
  std::uint64_t every = 1;     ///< one query of so many was recorded
  double ns_per_tick = 0;      ///< 0: not known
  bool cut_off = false;        ///< the file ends within a chunk, or without its last chunk
};

/// Reads a capture. `first` and `last` limit the queries read (numbers, both included). Throws InputError
/// that names chunk, query and event for a file that is not a capture, of another version, or inconsistent:
/// an id that was not defined, a node or triangle that a tree or mesh does not have, a matrix that is not
/// rigid within 1e-6, events without a query. A file that was cut off is read up to its last whole chunk.
Capture read_capture(const std::string& path, std::uint32_t first = 1, std::uint32_t last = kNull);
/// Reads a capture from memory; `name` is used in messages.
Capture parse_capture(std::span<const std::byte> bytes, const std::string& name, std::uint32_t first = 1,
                      std::uint32_t last = kNull);
/// Returns true if the bytes begin as a capture does.
bool is_capture(std::span<const std::byte> bytes);

/// Reads a capture while it is written, for example from a pipe.
///
///   capture::Stream stream("my_program");
///   for (std::span<const std::byte> bytes = ...) stream.feed(bytes, [&](capture::Query query) { ... });
class Stream {
 public:
  /// `name` is used in messages.
  explicit Stream(const std::string& name);
  ~Stream();
  Stream(Stream&&) noexcept;
  Stream& operator=(Stream&&) noexcept;

  /// Reads the next bytes, and calls `on_query` for each query that ends in them. Events that helping threads
  /// write after the end of their query are left out. Throws InputError as read_capture() does; then the
  /// stream cannot be continued.
  void feed(std::span<const std::byte> bytes, const std::function<void(Query query)>& on_query);

  /// The engine, names, meshes and trees read so far; without queries. The reference stays valid, those to
  /// elements become invalid with the next feed(). `cut_off` is false once the last chunk was read.
  const Capture& descriptions() const;
  bool has_begun() const;          ///< the header was read
  std::size_t unfinished() const;  ///< number of queries that began and did not end

 private:
  class Chunks;
  std::unique_ptr<Chunks> chunks_;
};

}  // namespace lrb::capture
