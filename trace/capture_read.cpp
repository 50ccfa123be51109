/// Reads captures, their queries and events: capture_descriptions.hpp reads the rest.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "trace/capture_descriptions.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::capture {
namespace {

/// Bits of the first byte of an event, above its kind.
constexpr std::uint8_t kMet = 4, kCounted = 8, kHasAxis = 16, kKnownBits = 31;
constexpr std::size_t kLeastEvent = 3;  ///< bytes of an event in the file

/// Returns the largest error of r as a rotation: of the products of its columns, and of its determinant.
double error_as_rotation(const Eigen::Matrix3d& r) {
  const double products = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  const double error = std::max(products, std::abs(r.determinant() - 1));
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

}  // namespace

Pose pose_of(const Probe& probe) {
  Pose out;
  const Eigen::Map<const Eigen::Vector3d> first(probe.numbers.data()), second(probe.numbers.data() + 3);
  if (probe.shape == ProbeShape::point) out.t = first;
  if (probe.shape != ProbeShape::ray) return out;
  Eigen::Vector3d along = second;
  if (!(std::abs(along.squaredNorm() - 1) < kRigid / 2)) along = along.stableNormalized();
  const Eigen::Vector3d across = along.unitOrthogonal();
  out.r << along, across, along.cross(across);
  out.t = first;
  return out;
}

/// A query while its events arrive. Chunks of several threads alternate.
struct Growing {
  struct Stored {
    std::uint32_t thread = 0;
    std::vector<Event> events;
    bool rooted = false;                                   ///< its first test of nodes was checked
    std::array<std::uint32_t, 2> instances{kNull, kNull};  ///< that it entered; kNull: the tree itself
    std::uint64_t entered = 0;                             ///< how often
  };
  Query query;
  std::uint64_t begin_ticks = 0, took_ticks = 0;
  std::vector<Stored> parts;                      ///< parts[0]: the thread that began the query
  std::map<std::uint32_t, std::size_t> part_now;  ///< by thread: index of its last part
};

class Reader : public Descriptions {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& name, std::uint32_t first, std::uint32_t last)
      : Descriptions(bytes, name), first_(first), last_(last) {}

  Capture read() {
    read_header();
    out_.cut_off = true;  // until STOP was read
    at_ = kFileHeader;
    while (bytes_.size() - at_ >= kChunkHeader && read_chunk()) {
    }
    if (at_ != bytes_.size()) out_.cut_off = true;
    finish();
    return std::move(out_);
  }

  // Reads a stream. `base`: the offset of `bytes` in it.

  /// Starts a stream. `bytes` is its complete header.
  void begin_stream(std::span<const std::byte> bytes) {
    bytes_ = bytes;
    streaming_ = out_.cut_off = true;
    read_header();
  }
  /// Reads a chunk, and returns the query that it ends.
  std::optional<Query> read_part(std::span<const std::byte> chunk, std::uint64_t base) {
    bytes_ = chunk, base_ = base, at_ = 0;
    read_chunk();
    if (ended_ == 0) return std::nullopt;
    const auto found = queries_.find(std::exchange(ended_, 0));
    out_.ns_per_tick = ns_per_tick();
    Query query = completed(found->second);
    queries_.erase(found);
    return query;
  }
  const Capture& out() const { return out_; }
  std::size_t unfinished() const { return queries_.size(); }

 private:
  /// Reads the next chunk. Returns false if it is not whole.
  bool read_chunk() {
    if (!open_next()) return false;
    if (read_content()) require(left() == 0, "more content than its counts say; the file is damaged");
    skip_content();
    return true;
  }

  /// Returns false for an unknown chunk, whose content is skipped.
  bool read_content() {
    static const std::pair<std::string_view, void (Reader::*)()> kKinds[] = {
        {"HEAD", &Reader::read_engine}, {"SYNC", &Reader::read_sync},   {"STOP", &Reader::read_stop},
        {"NAME", &Reader::read_name},   {"MESH", &Reader::read_mesh},   {"TREE", &Reader::read_tree},
        {"QRYB", &Reader::read_begin},  {"QRYE", &Reader::read_answer}, {"EVTS", &Reader::read_events},
        {"VALU", &Reader::read_value},  {"RATE", &Reader::read_rate}};
    for (const auto& [kind, read] : kKinds) {
      if (kind_ != kind) continue;
      const std::uint32_t known = kind_ == "QRYB" || kind_ == "TREE" ? 2 : 1;  // of a probe, of instances
      if (version_ == 0 || version_ > known)
        fail("expected version " + text(known) + ", found " + text(version_) + "; use a newer lrbscope");
      (this->*read)();
      return true;
    }
    return false;
  }

  void read_engine() { out_.engine = printable_name(characters(left())); }

  void read_sync() {
    const std::uint64_t wall = u64();
    if (!synced_) first_ticks_ = ticks_, first_wall_ = wall;
    synced_ = true, last_ticks_ = ticks_, last_wall_ = wall;
  }
  void read_stop() {
    read_sync();
    out_.cut_off = false;
  }

  void read_rate() {
    out_.every = u64();
    require(
        out_.every != 0 && out_.every >> 32 == 0 && last_begun_ == 0,
        "expected a number from 1 to 2^32 - 1 before the first query; call LRBCAP_EVERY after LRBCAP_OPEN");
  }

  void read_begin() {
    u64();  // reserved
    query_ = u32();
    const std::uint32_t kind = u32(), a = u32(), b = u32();
    u64();  // reserved
    const std::uint32_t thread = u32(), shape = u32();
    require(query_ != 0, "expected a number of a query above 0; the file is damaged");
    Growing growing;
    Query& query = growing.query;
    query.number = query_;
    if (kind < 1 || kind > 6)
      fail("expected a query of kind 1 (all pairs) to 6 (shape), found " + text(kind) +
           "; see docs/capture.md");
    query.kind = static_cast<QueryKind>(kind - 1);  // kinds of a file begin with 1
    query.trees = {a == 0 ? kNull : index_of(trees_, a, "tree"),
                   b == 0 ? kNull : index_of(trees_, b, "tree")};
    query.poses[0] = read_pose('A');
    if (version_ == 1)
      query.poses[1] = read_pose('B');
    else
      read_probe(query, shape);
    query.thread = thread;
    growing.begin_ticks = ticks_;
    growing.parts.emplace_back().thread = thread;
    last_begun_ = std::max(last_begun_, query_);
    if (!queries_.try_emplace(query_, std::move(growing)).second)
      fail("begins a second time; the file is damaged, or two programs wrote to it");
  }

  Pose read_pose(char side) {
    const std::vector<double> m = numbers<double>(12);
    const Pose rows = io::pose_of(std::span<const double, 12>(m.data(), 12));
    const std::string pose = std::string("pose of ") + side + ": ";
    const double error = error_as_rotation(rows.r);
    if (!(error <= kRigid)) {
      const bool by_columns = error_as_rotation(Eigen::Map<const Eigen::Matrix3d>(m.data())) <= kRigid;
      fail(
          pose + "expected a rotation within 1e-6, found an error of " + io::number_text(error, 3) +
          " (determinant " + io::number_text(rows.r.determinant(), 6) +
          "); poses are 12 doubles, 3x4 row by row" +
          (by_columns ? ", and this one is rigid if read column by column" : ", without scale or mirroring"));
    }
    if (!rows.t.allFinite()) fail(pose + "expected a finite translation; give the pose that the engine used");
    return rows;
  }

  void read_probe(Query& query, std::uint32_t shape) {
    if (shape < 1 || shape > 3)
      fail("expected a ray (1), a point (2) or a box (3), found " + text(shape) + "; see docs/capture.md");
    query.probe.shape = static_cast<ProbeShape>(shape);
    if (query.trees[0] == kNull || query.trees[1] != kNull || query.kind > QueryKind::distance)
      fail("expected a query of kind all pairs, any or distance of one described tree with a " +
           std::string(name_of(query.probe.shape)) + ", found another; see docs/capture.md");
    const std::vector<double> all = numbers<double>(12);
    std::array<double, 8>& n = query.probe.numbers;
    std::copy_n(all.begin(), n.size(), n.begin());
    const bool is_ray = shape == 1, is_box = shape == 3;
    // Squares and sums of larger numbers overflow.
    constexpr double kMax = 1e150;
    bool valid = std::all_of(n.begin(), n.end() - is_ray, [&](double x) { return std::abs(x) <= kMax; });
    if (is_ray) valid = valid && (n[3] != 0 || n[4] != 0 || n[5] != 0) && n[6] <= n[7];
    for (std::size_t k = 0; is_box && k < 3; ++k) valid = valid && n[k] <= n[k + 3];
    if (!valid) {
      std::string found;
      for (const double x : n) found += ' ' + io::number_text(x);
      fail(
          "expected finite numbers of at most 1e150, of a ray a direction and a range of its multiples, which may be endless, of "
          "a box least and greatest x, y, z, found" +
          found + "; give those of the engine");
    }
    query.poses[1] = pose_of(query.probe);
  }

  Growing& begun() {
    const auto found = queries_.find(query_);
    require(found != queries_.end(), "the query was not begun; pass what LRBCAP_BEGIN returned");
    return found->second;
  }

  void read_value() {
    query_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(u64(), kNull));
    Query& query = begun().query;
    const auto lower = number<double>(), upper = number<double>();
    require(query.kind == QueryKind::distance,
            "expected a value of a distance query only; see LRBCAP_VALUE in docs/capture.md");
    require(!query.ended && !query.value,
            "expected one value, before the end of its query; call LRBCAP_VALUE once");
    if (!(std::isfinite(lower) && lower <= upper && std::isfinite(upper)))
      fail("expected a finite lower bound of the distance and an upper one above it, found " +
           io::number_text(lower) + " and " + io::number_text(upper) +
           "; give the engine's distance twice if it has no bounds");
    query.value = {lower, upper};
  }

  void read_answer() {
    const std::uint64_t took = u64();
    query_ = u32();
    Growing& growing = begun();
    Query& query = growing.query;
    const std::uint32_t verdict = u32();
    if (verdict > 2)
      fail("expected the verdict 0 (separate), 1 (intersecting) or 2 (unreported), found " + text(verdict) +
           "; see docs/capture.md");
    require(!query.ended, "ends a second time; the file is damaged, or two programs wrote to it");
    query.ended = true;
    query.verdict = static_cast<Verdict>(verdict);
    growing.took_ticks = took;
    query.pairs = u64();
    query.events_seen = u64();
    u64();  // reserved
    ended_ = query_;
    const std::uint64_t entered = growing.parts[0].entered, stored = growing.parts[0].events.size() + entered;
    if (is_wanted() && query.events_seen < stored)
      fail("expected at least the " + text(stored) + " events stored, found " + text(query.events_seen) +
           "; the file is damaged");
    if (is_wanted()) query.events_seen -= entered;
  }

  bool is_wanted() const { return query_ >= first_ && query_ <= last_; }

  /// Finds the part to which a thread's events belong. `first`: the number of its events before.
  Growing::Stored& part_of(Growing& growing, std::uint32_t thread, std::uint64_t first) {
    const bool own = thread == growing.query.thread;
    if (own) require(!growing.query.ended, "events after the end of their query; the file is damaged");
    auto now = growing.part_now.find(thread);
    if (first == 0 && own && now == growing.part_now.end())
      now = growing.part_now.emplace(thread, 0).first;
    else if (first == 0 && !own) {  // a thread may join a query again
      now = growing.part_now.insert_or_assign(thread, growing.parts.size()).first;
      growing.parts.emplace_back().thread = thread;
    }
    std::uint64_t stored = 0;
    if (now != growing.part_now.end())
      stored = growing.parts[now->second].events.size() + growing.parts[now->second].entered;
    if (stored != first)
      fail("expected event " + text(stored) + " of thread " + text(thread) + " next, found event " +
           text(first) + "; the file is damaged");
    return growing.parts[now->second];
  }

  void read_events() {
    query_ = u32();
    const std::uint32_t thread = u32();
    const std::uint64_t first = u64();
    const std::uint32_t count = u32();
    u32();  // number of this chunk among those of the thread
    // A stream no longer has its ended queries.
    if (streaming_ && query_ <= last_begun_ && !queries_.contains(query_)) {
      at_ = end_;
      return;
    }
    Growing& growing = begun();
    if (!is_wanted()) {
      at_ = end_;
      return;
    }
    require(count <= left() / kLeastEvent, "fewer bytes than its events need; the file is damaged");
    Growing::Stored& part = part_of(growing, thread, first);
    // Grows by a factor, as a query may consist of many chunks.
    if (part.events.capacity() < first + count) part.events.reserve(std::max(first + count, 2 * first));
    // a and b are differences from the event of the same kind before, in the same chunk.
    std::uint32_t a[4] = {}, b[4] = {};
    for (std::uint32_t i = 0; i < count; ++i) {
      event_ = first + i + 1;
      const auto head = number<std::uint8_t>();
      require((head & ~kKnownBits) == 0, "unknown bits of an event; the file is damaged");
      Event e;
      const unsigned kind = head & 3u;
      e.kind = static_cast<EventKind>(kind);
      e.met = (head & kMet) != 0;
      if ((head & kCounted) != 0) e.tests = number<std::uint8_t>(), e.met = number<std::uint8_t>();
      if ((head & kHasAxis) != 0) e.axis = number<std::uint8_t>();
      e.a = a[kind] += difference();
      e.b = b[kind] += difference();
      if (enters(growing.query, part, e)) continue;
      convert(growing.query, part, e);
      if (e.kind == EventKind::nodes && !part.rooted) check_start(growing, part, e);
      part.events.push_back(e);
    }
    event_ = 0;
  }

  /// Reads a signed difference, modulo 2^32: seven bits per byte, the least first; the sign is the lowest
  /// bit.
  std::uint32_t difference() {
    std::uint32_t z = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const auto byte = number<std::uint8_t>();
      require(shift < 28 || byte < 16, "a number of more than 32 bits; the file is damaged");
      z |= static_cast<std::uint32_t>(byte & 127) << shift;
      if ((byte & 128) == 0) break;
    }
    return (z >> 1) ^ (0u - (z & 1));
  }

  const std::vector<Instance>& instances_of(std::uint32_t tree) const {
    static const std::vector<Instance> kNone;
    return tree == kNull ? kNone : out_.trees[tree].instances;
  }

  /// Returns true for an event that enters instances: a test of none.
  bool enters(const Query& query, Growing::Stored& part, const Event& e) {
    const std::uint32_t numbers[] = {e.a, e.b};
    const bool has_instances = !instances_of(query.trees[0]).empty() || !instances_of(query.trees[1]).empty();
    if (e.kind != EventKind::nodes || e.tests != 0 || e.met != 0 || e.axis != kNoAxis || !has_instances)
      return false;
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
      if (const std::size_t count = instances_of(query.trees[side]).size();
          numbers[side] != kNull && numbers[side] >= count)
        fail(std::string("expected an instance of ") + "AB"[side] + " below " + text(count) +
             ", or LRBCAP_TOP, found " + text(numbers[side]) + "; see LRBCAP_ENTER in docs/capture.md");
    part.instances = {e.a, e.b};
    ++part.entered;
    return true;
  }

  /// Checks an event, and replaces the engine's ids by our numbers.
  void convert(const Query& query, const Growing::Stored& part, Event& e) {
    if (e.tests == 0 || e.met > e.tests)
      fail("expected at least one test and no more overlaps than tests, found " + text(e.met) + " of " +
           text(e.tests) + "; see LRBCAP_NODES in docs/capture.md");
    if (e.axis > 14 && e.axis < 32)
      fail("expected the axis 0-14, 32 + a direction, or 255, found " + text(e.axis) +
           "; see docs/capture.md");
    if (e.kind == EventKind::count || e.kind == EventKind::phase) {
      e.a = index_of(names_, e.a, "name");
      return;
    }
    std::uint32_t* const numbers[] = {&e.a, &e.b};
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const std::uint32_t tree = query.trees[side];
      if (side == 1 && query.probe.shape != ProbeShape::none && e.b != 0)
        fail("expected node and triangle 0 of the " + std::string(name_of(query.probe.shape)) +
             " (B), found " + text(e.b) + "; name it 0");
      if (tree == kNull) continue;
      const std::vector<Instance>& all = out_.trees[tree].instances;
      const bool is_inside = part.instances[side] != kNull;
      const Instance at = is_inside ? all[part.instances[side]] : Instance{tree, 0, 0};
      if (e.kind == EventKind::nodes) {
        convert_node(at.tree, "AB"[side], *numbers[side]);
        *numbers[side] += at.first_node;
      } else {
        if (!is_inside && !all.empty())
          fail(std::string("expected LRBCAP_ENTER before a test of triangles of ") + "AB"[side] +
               ", a tree of instances, found none; see docs/capture.md");
        check_triangle(at.tree, "AB"[side], *numbers[side]);
        *numbers[side] += at.first_triangle;
      }
    }
  }
  void convert_node(std::uint32_t tree, char side, std::uint32_t& id) const {
    const auto& table = node_of_[tree];
    const Tree& its = out_.trees[tree];
    const std::size_t size = its.instances.empty() ? its.size() : its.instances.front().first_node;
    if (table.empty() && id < size) return;
    const auto found = std::lower_bound(table.begin(), table.end(), std::pair(id, std::uint32_t{0}));
    if (found == table.end() || found->first != id)
      fail("expected a node of tree " + text(its.id) + " (" + side + "), which has " + text(size) +
           " nodes, found id " + text(id) + "; use the ids of the tree's description");
    id = found->second;
  }
  void check_triangle(std::uint32_t tree, char side, std::uint32_t triangle) const {
    const std::size_t size = out_.meshes[out_.trees[tree].mesh].triangles.size();
    if (triangle >= size)
      fail(std::string("expected a triangle of ") + side + " below " + text(size) + ", found " +
           text(triangle) + "; use the numbers of the mesh's description");
  }

  /// Checks that a traversal begins at the roots or their children: an engine need not test the roots, or may
  /// compare one with the children of the other. That of helpers and of a query of one tree with itself
  /// (which may begin with siblings) need not.
  void check_start(const Growing& growing, Growing::Stored& part, const Event& e) const {
    part.rooted = true;
    if (&part != &growing.parts[0] || growing.query.kind == QueryKind::self ||
        growing.query.kind == QueryKind::shape)
      return;
    const std::uint32_t nodes[] = {e.a, e.b};
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const std::uint32_t tree = growing.query.trees[side];
      if (tree == kNull || nodes[side] == 0) continue;
      const auto children = out_.trees[tree].children(0);
      if (std::find(children.begin(), children.end(), nodes[side]) == children.end())
        fail("expected the roots or their children in the first test of nodes, found node " +
             out_.trees[tree].name_of_node(nodes[side]) + " of " + "AB"[side] +
             "; check the order of A and B, the tree, and that node 0 of its description is the root");
    }
  }

  /// Orders queries and their parts, with times.
  void finish() {
    out_.ns_per_tick = ns_per_tick();
    std::vector<std::uint32_t> order;
    for (const auto& [number, growing] : queries_)
      if (number >= first_ && number <= last_) order.push_back(number);
    std::sort(order.begin(), order.end());
    out_.queries.reserve(order.size());
    for (const std::uint32_t number : order) {
      out_.queries.push_back(completed(queries_.find(number)->second));
    }
  }
  /// Returns the length of a tick by the clock readings so far; 0 if they do not determine it.
  double ns_per_tick() const {
    const double ticks = static_cast<double>(last_ticks_) - static_cast<double>(first_ticks_);
    const double wall = static_cast<double>(last_wall_) - static_cast<double>(first_wall_);
    return ticks > 0 && wall > 0 ? wall / ticks : 0;
  }
  Query completed(Growing& growing) const {
    Query& query = growing.query;
    query.begin_ns =
        (static_cast<double>(growing.begin_ticks) - static_cast<double>(first_ticks_)) * out_.ns_per_tick;
    query.duration_ns = static_cast<double>(growing.took_ticks) * out_.ns_per_tick;
    join_parts(growing);
    return std::move(query);
  }
  static void join_parts(Growing& growing) {
    std::vector<Growing::Stored>& parts = growing.parts;
    if (parts.size() == 1 && parts[0].events.empty()) return;
    std::stable_sort(parts.begin() + 1, parts.end(),
                     [](const auto& a, const auto& b) { return a.thread < b.thread; });
    std::vector<Event>& events = growing.query.events;
    for (Growing::Stored& part : parts) {
      growing.query.parts.push_back({part.thread, events.size(), part.events.size()});
      if (events.empty())
        events = std::move(part.events);
      else
        events.insert(events.end(), part.events.begin(), part.events.end());
      part.events = {};
    }
  }

  std::uint32_t first_, last_;
  bool synced_ = false;
  std::uint64_t first_ticks_ = 0, first_wall_ = 0, last_ticks_ = 0, last_wall_ = 0;
  std::unordered_map<std::uint32_t, Growing> queries_;

  // Of a stream.
  bool streaming_ = false;
  std::uint32_t last_begun_ = 0;  ///< greatest number of a query that began
  std::uint32_t ended_ = 0;       ///< the query that the current chunk ends; 0: none
};

Capture parse_capture(std::span<const std::byte> bytes, const std::string& name, std::uint32_t first,
                      std::uint32_t last) {
  return Reader(bytes, name, first, last).read();
}

Capture read_capture(const std::string& path, std::uint32_t first, std::uint32_t last) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown) && !unknown)
    throw InputError(printable_name(path) +
                     ": no such file; check the path, and that the engine was compiled with -DLRBCAP_ENABLE "
                     "and run with LRBCAP_OUT");
  const std::string bytes = read_file(path);
  return parse_capture(std::as_bytes(std::span(bytes)), path, first, last);
}

class Stream::Chunks {
 public:
  explicit Chunks(const std::string& name) : reader(std::span<const std::byte>(), name, 1, kNull) {}

  Reader reader;
  std::vector<std::byte> waiting;  ///< bytes that are not a whole chunk yet
  std::uint64_t offset = 0;        ///< of the first waiting byte in the stream
  bool has_begun = false;
};

Stream::Stream(const std::string& name) : chunks_(std::make_unique<Chunks>(name)) {}
Stream::~Stream() = default;
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;

void Stream::feed(std::span<const std::byte> bytes, const std::function<void(Query query)>& on_query) {
  Chunks& c = *chunks_;
  if (bytes.empty()) return;
  c.waiting.insert(c.waiting.end(), bytes.begin(), bytes.end());
  std::size_t at = 0;
  // Bytes that do not begin as a capture are rejected at once: there may be fewer than a header's.
  const std::size_t known = std::min(c.waiting.size(), kMagic.size());
  const bool is_other = std::memcmp(c.waiting.data(), kMagic.data(), known) != 0;
  if (!c.has_begun && (is_other || c.waiting.size() >= kFileHeader)) {
    c.reader.begin_stream(c.waiting);
    c.has_begun = true;
    at = kFileHeader;
  }
  while (c.has_begun && c.waiting.size() - at >= kChunkHeader) {
    const std::span<const std::byte> rest = std::span(c.waiting).subspan(at);
    std::uint64_t size = 0;
    std::memcpy(&size, rest.data() + 8, sizeof size);
    // A chunk with a damaged name, or another capture, is also rejected at once: it has no size to wait for.
    const std::string_view name(reinterpret_cast<const char*>(rest.data()), 4);
    const bool is_chunk = is_chunk_name(name) && name != kMagic.substr(0, 4);
    if (is_chunk && size > rest.size() - kChunkHeader) break;
    const std::size_t used =
        kChunkHeader + static_cast<std::size_t>(std::min<std::uint64_t>(size, rest.size()));
    if (std::optional<Query> query =
            c.reader.read_part(rest.first(std::min(used, rest.size())), c.offset + at))
      on_query(std::move(*query));
    at += used;
  }
  c.waiting.erase(c.waiting.begin(), c.waiting.begin() + static_cast<std::ptrdiff_t>(at));
  c.offset += at;
}

const Capture& Stream::descriptions() const {
  return chunks_->reader.out();
}
bool Stream::has_begun() const {
  return chunks_->has_begun;
}
std::size_t Stream::unfinished() const {
  return chunks_->reader.unfinished();
}

}  // namespace lrb::capture
