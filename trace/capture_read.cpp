/// Reads captures: docs/capture.md describes the format.
///
/// A file is untrusted. Every count is compared with the bytes left in its chunk before anything is
/// allocated, so that memory is bounded by a multiple of the file's size.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include <Eigen/LU>

#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::capture {
namespace {

static_assert(std::endian::native == std::endian::little, "captures are read in the order of their writers");

constexpr std::string_view kMagic("LRBCAP\r\n", 8);
constexpr std::uint32_t kVersion = 1, kByteOrder = 0x01020304, kOtherByteOrder = 0x04030201;
constexpr std::size_t kFileHeader = 16, kChunkHeader = 24;
constexpr double kRigid = 1e-6;  ///< of a rotation's determinant and of the products of its columns

/// Bits of the word of options of a TREE.
constexpr std::uint32_t kHasIds = 1, kFloatVolumes = 2, kSplits = 4;
/// Bits of the first byte of an event, above its kind.
constexpr std::uint8_t kMet = 4, kCounted = 8, kHasAxis = 16, kKnownBits = 31;
constexpr std::size_t kLeastEvent = 3;  ///< bytes of an event in the file

/// Returns the number of doubles per volume; 0 for an unknown kind.
std::uint64_t numbers_of(std::uint32_t kind, std::uint64_t directions) {
  switch (static_cast<VolumeKind>(kind)) {
    case VolumeKind::aabb:
      return 6;
    case VolumeKind::sphere:
      return 4;
    case VolumeKind::obb:
      return 12;
    case VolumeKind::rss:
      return 10;
    case VolumeKind::kdop:
      return 2 * directions;
  }
  return 0;
}

bool is_chunk_name(std::string_view name) {
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

/// Returns the largest error of r as a rotation: of the products of its columns, and of its determinant.
double error_as_rotation(const Eigen::Matrix3d& r) {
  const double products = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  const double error = std::max(products, std::abs(r.determinant() - 1));
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

std::string text(std::uint64_t number) {
  return std::to_string(number);
}

}  // namespace

/// A query while its events arrive. Chunks of several threads alternate.
struct Growing {
  struct Stored {
    std::uint32_t thread = 0;
    std::vector<Event> events;
    bool rooted = false;  ///< its first test of nodes was checked
  };
  Query query;
  std::uint64_t begin_ticks = 0, took_ticks = 0;
  std::vector<Stored> parts;                      ///< parts[0]: the thread that began the query
  std::map<std::uint32_t, std::size_t> part_now;  ///< by thread: index of its last part
};

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& name, std::uint32_t first, std::uint32_t last)
      : bytes_(bytes), name_(printable_name(name)), first_(first), last_(last) {}

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
  /// Throws an InputError: the name, the location and the fault.
  [[noreturn]] void fail(const std::string& what) const {
    std::string where = name_ + ":";
    if (chunk_ != 0)
      where += " chunk " + text(chunk_) + " (" + kind_ + " at byte " + text(base_ + begin_) + ")";
    if (query_ != 0) where += (chunk_ != 0 ? ", query " : " query ") + text(query_);
    if (event_ != 0) where += ", event " + text(event_);
    throw InputError(where + (chunk_ != 0 || query_ != 0 ? ": " : " ") + what);
  }
  void require(bool holds, const char* what) const {
    if (!holds) fail(what);
  }

  void read_header() {
    const auto file = std::string_view(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    if (!is_capture(bytes_))
      fail("expected a capture (LRBCAP ...), found " + content_of(file) +
           "; record one with lrbscope_capture.h");
    if (bytes_.size() < kFileHeader)
      fail("expected 16 bytes of file header, found " + text(bytes_.size()) + "; record the capture again");
    end_ = kFileHeader;
    at_ = kMagic.size();
    const auto version = number<std::uint32_t>(), order = number<std::uint32_t>();
    if (order == kOtherByteOrder)
      fail("expected little-endian numbers, found a capture of a big-endian machine; record it on another");
    if (order != kByteOrder)
      fail("expected the byte order mark 01020304, found another; the file is damaged");
    if (version != kVersion)
      fail("expected version 1 of the format, found " + text(version) +
           "; use an lrbscope_capture.h and an lrbscope that belong together");
  }

  /// Returns what a file that is not a capture looks like.
  static std::string content_of(std::string_view file) {
    if (file.empty()) return "an empty file";
    const std::string_view begin = file.substr(0, 256);
    if (begin.starts_with("\x1f\x8b")) return "a gzip file (unpack it)";
    if (begin.starts_with('{') || begin.starts_with('[')) return "JSON";
    const bool is_text = std::all_of(begin.begin(), begin.end(), [](char c) {
      return static_cast<unsigned char>(c) >= ' ' || c == '\n' || c == '\r' || c == '\t';
    });
    return (is_text ? "text: " : "other bytes: ") + in_quotes(begin.substr(0, begin.find('\n')), 20);
  }

  // The current chunk, in order.

  std::size_t left() const { return end_ - at_; }
  template <class Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    require(left() >= sizeof(Number), "the content ends too early; the file is damaged");
    Number x;
    std::memcpy(&x, bytes_.data() + at_, sizeof x);
    at_ += sizeof x;
    return x;
  }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  template <class Number>
  std::vector<Number> numbers(std::uint64_t count) {
    require(count <= left() / sizeof(Number),
            "the content is smaller than its counts say; the file is damaged");
    std::vector<Number> out(count);
    if (count != 0) std::memcpy(out.data(), bytes_.data() + at_, count * sizeof(Number));
    at_ += count * sizeof(Number);
    return out;
  }
  std::string characters(std::uint64_t count) {
    const std::vector<char> read = numbers<char>(count);
    return {read.begin(), read.end()};
  }

  /// Reads the next chunk. Returns false if it is not whole.
  bool read_chunk() {
    begin_ = at_, end_ = bytes_.size(), ++chunk_, query_ = 0, event_ = 0;
    kind_ = characters(4);
    if (kind_ == kMagic.substr(0, 4))
      fail("a second capture begins here; give each program a file of its own");
    if (!is_chunk_name(kind_)) {
      kind_ = in_quotes(kind_);
      fail("expected a chunk name of four letters; the file is damaged");
    }
    const std::uint32_t version = u32();
    const std::uint64_t size = u64();
    ticks_ = u64();
    if (size > left()) {
      at_ = begin_;
      return false;
    }
    end_ = at_ + size;
    if (read_content(version)) require(left() == 0, "more content than its counts say; the file is damaged");
    at_ = end_;
    return true;
  }

  /// Returns false for an unknown chunk, whose content is skipped.
  bool read_content(std::uint32_t version) {
    static constexpr std::pair<std::string_view, void (Reader::*)()> kKinds[] = {
        {"HEAD", &Reader::read_engine}, {"SYNC", &Reader::read_sync},   {"STOP", &Reader::read_stop},
        {"NAME", &Reader::read_name},   {"MESH", &Reader::read_mesh},   {"TREE", &Reader::read_tree},
        {"QRYB", &Reader::read_begin},  {"QRYE", &Reader::read_answer}, {"EVTS", &Reader::read_events},
        {"VALU", &Reader::read_value}};
    for (const auto& [kind, read] : kKinds) {
      if (kind_ != kind) continue;
      if (version != 1) fail("expected version 1, found " + text(version) + "; use a newer lrbscope");
      (this->*read)();
      return true;
    }
    return false;
  }

  void read_engine() { out_.engine = printable_name(characters(left())); }  // reaches the terminal

  void read_sync() {
    const std::uint64_t wall = u64();
    if (!synced_) first_ticks_ = ticks_, first_wall_ = wall;
    synced_ = true, last_ticks_ = ticks_, last_wall_ = wall;
  }
  void read_stop() {
    read_sync();
    out_.cut_off = false;
  }

  /// Assigns the next index to an id of the engine, which must be new.
  void define(std::unordered_map<std::uint32_t, std::uint32_t>& ids, std::uint32_t id, const char* what) {
    if (id == 0 || !ids.emplace(id, static_cast<std::uint32_t>(ids.size())).second)
      fail(std::string("expected a new id of a ") + what + " above 0, found " + text(id) +
           "; the file is damaged, or two programs wrote to it");
  }

  void read_name() {
    define(names_, u32(), "name");
    out_.names.push_back(characters(left()));
  }

  void read_mesh() {
    define(meshes_, u32(), "mesh");
    const std::uint32_t vertices = u32(), triangles = u32(), length = u32();
    Mesh mesh;
    mesh.name = characters(length);
    const std::vector<double> xyz = numbers<double>(std::uint64_t{3} * vertices);
    const std::vector<std::uint32_t> corners = numbers<std::uint32_t>(std::uint64_t{3} * triangles);
    mesh.vertices.reserve(vertices);
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      mesh.vertices.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
      if (!mesh.vertices.back().allFinite())
        fail("vertex " + text(i / 3) + ": expected finite numbers; describe the mesh as the engine has it");
    }
    mesh.triangles.reserve(triangles);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
      for (const std::uint32_t v : mesh.triangles.back())
        if (v >= vertices)
          fail("triangle " + text(i / 3) + ": expected a vertex below " + text(vertices) + ", found " +
               text(v) + "; count vertices from 0");
    }
    out_.meshes.push_back(std::move(mesh));
  }

  void read_tree() {
    Tree tree;
    define(trees_, tree.id = u32(), "tree");
    const std::uint32_t mesh = u32(), replaces = u32(), nodes = u32(), kind = u32(), directions = u32();
    const std::uint32_t options = u32();
    u32();  // reserved
    tree.mesh = index_of(meshes_, mesh, "mesh");
    if (replaces != 0) {
      tree.replaces = index_of(trees_, replaces, "tree");
      if (replaces == tree.id) fail("tree " + text(tree.id) + " replaces itself; name the tree before it");
    }
    require(nodes != 0 && nodes != kNull, "expected at least one node; also describe the root");
    require((options & ~(kHasIds | kFloatVolumes | kSplits)) == 0,
            "unknown options of a tree; use a newer lrbscope");
    require(kind != static_cast<std::uint32_t>(VolumeKind::kdop) || directions <= left() / 24,
            "more directions than its content has room for; the file is damaged");
    const std::uint64_t per_node = numbers_of(kind, directions);
    if (per_node == 0)
      fail("expected a bounding volume of kind 1 (AABB) to 5 (k-DOP with directions), found kind " +
           text(kind) + "; see docs/capture.md");
    tree.volume = static_cast<VolumeKind>(kind);
    tree.splits = (options & kSplits) != 0;
    require(
        !tree.splits || (tree.volume != VolumeKind::sphere && tree.volume != VolumeKind::rss),
        "expected AABBs, OBBs or k-DOPs of a tree with spatial splits, found spheres or RSS; leave LRBCAP_SPLITS out");
    if ((options & kHasIds) != 0) tree.ids = numbers<std::uint32_t>(nodes);
    read_ranges(nodes, nodes, "child", tree.first_child, tree.child);
    read_ranges(nodes, kNull, "triangle", tree.first_triangle, tree.triangle);
    if ((options & kFloatVolumes) != 0) {
      const std::vector<float> floats = numbers<float>(nodes * per_node);
      tree.volumes.assign(floats.begin(), floats.end());
    } else {
      tree.volumes = numbers<double>(nodes * per_node);
    }
    for (std::size_t i = 0; i < tree.volumes.size(); ++i)
      if (!std::isfinite(tree.volumes[i]))
        fail("node " + text(i / per_node) + ": expected finite numbers of its volume, found " +
             io::number_text(tree.volumes[i]) + "; describe the volumes after the tree was built");
    if (tree.volume == VolumeKind::kdop) {
      const std::vector<double> xyz = numbers<double>(std::uint64_t{3} * directions);
      for (std::size_t i = 0; i < xyz.size(); i += 3) {
        tree.directions.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
        if (!tree.directions.back().allFinite() || tree.directions.back().isZero(0))
          fail("direction " + text(i / 3) +
               ": expected a finite vector that is not zero; see docs/capture.md");
      }
    }
    index_nodes(tree);
    out_.trees.push_back(std::move(tree));
  }

  /// Reads n + 1 offsets and the indices to which they refer, which must be below `end`.
  void read_ranges(std::uint32_t n, std::uint32_t end, const char* what, std::vector<std::uint32_t>& offsets,
                   std::vector<std::uint32_t>& indices) {
    offsets = numbers<std::uint32_t>(std::uint64_t{n} + 1);
    const std::string of_kind = std::string("offsets of ") + what + " indices: ";
    if (offsets[0] != 0)
      fail(of_kind + "expected 0 first, found " + text(offsets[0]) + "; see docs/capture.md");
    for (std::uint32_t i = 0; i < n; ++i)
      if (offsets[i + 1] < offsets[i])
        fail(of_kind + "expected ascending numbers, found " + text(offsets[i + 1]) + " after " +
             text(offsets[i]) + " (node " + text(i) + "); give each node the range of its own");
    indices = numbers<std::uint32_t>(offsets[n]);
    if (end == kNull) return;
    const auto wrong =
        std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= end; });
    if (wrong == indices.end()) return;
    const auto position = static_cast<std::uint32_t>(wrong - indices.begin());
    const auto node = std::upper_bound(offsets.begin(), offsets.end(), position) - offsets.begin() - 1;
    fail("node " + text(static_cast<std::uint64_t>(node)) + ": expected a " + what + " below " + text(end) +
         ", found " + text(*wrong) + "; children are indices of nodes, not ids");
  }

  /// Makes the table from the engine's numbers of nodes to ours.
  void index_nodes(const Tree& tree) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>>& table = node_of_.emplace_back();
    for (std::uint32_t i = 0; i < tree.ids.size(); ++i) table.emplace_back(tree.ids[i], i);
    std::sort(table.begin(), table.end());
    for (std::size_t i = 1; i < table.size(); ++i)
      if (table[i].first == table[i - 1].first)
        fail("nodes " + text(table[i - 1].second) + " and " + text(table[i].second) + " have the same id, " +
             text(table[i].first) + "; give each node an id of its own");
  }

  std::uint32_t index_of(const std::unordered_map<std::uint32_t, std::uint32_t>& ids, std::uint32_t id,
                         const char* what) const {
    const auto found = ids.find(id);
    if (found == ids.end())
      fail(std::string("refers to ") + what + " " + text(id) +
           ", which was not described; describe it before");
    return found->second;
  }

  void read_begin() {
    u64();  // reserved
    query_ = u32();
    const std::uint32_t kind = u32(), a = u32(), b = u32();
    u64();  // reserved
    const std::uint32_t thread = u32();
    u32();  // reserved
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
    for (const int side : {0, 1}) query.poses[side] = read_pose(side == 0 ? 'A' : 'B');
    query.thread = thread;
    growing.begin_ticks = ticks_;
    growing.parts.push_back({thread, {}, false});
    last_begun_ = std::max(last_begun_, query_);
    if (!queries_.try_emplace(query_, std::move(growing)).second)
      fail("begins a second time; the file is damaged, or two programs wrote to it");
  }

  Pose read_pose(char side) {
    const std::vector<double> m = numbers<double>(12);
    Pose rows, columns;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        rows.r(i, j) = m[static_cast<std::size_t>(4 * i + j)];
        columns.r(i, j) = m[static_cast<std::size_t>(3 * j + i)];
      }
      rows.t(i) = m[static_cast<std::size_t>(4 * i + 3)];
    }
    const std::string pose = std::string("pose of ") + side + ": ";
    const double error = error_as_rotation(rows.r);
    if (!(error <= kRigid)) {
      const bool by_columns = error_as_rotation(columns.r) <= kRigid;
      fail(
          pose + "expected a rotation within 1e-6, found an error of " + io::number_text(error, 3) +
          " (determinant " + io::number_text(rows.r.determinant(), 6) +
          "); poses are 12 doubles, 3x4 row by row" +
          (by_columns ? ", and this one is rigid if read column by column" : ", without scale or mirroring"));
    }
    if (!rows.t.allFinite()) fail(pose + "expected a finite translation; give the pose that the engine used");
    return rows;
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
    if (is_wanted() && query.events_seen < growing.parts[0].events.size())
      fail("expected at least the " + text(growing.parts[0].events.size()) + " events stored, found " +
           text(query.events_seen) + "; the file is damaged");
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
      growing.parts.push_back({thread, {}, false});
    }
    const std::uint64_t stored = now == growing.part_now.end() ? 0 : growing.parts[now->second].events.size();
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
      convert(growing.query, e);
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

  /// Checks an event, and replaces the engine's ids by our numbers.
  void convert(const Query& query, Event& e) {
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
      if (tree == kNull) continue;
      if (e.kind == EventKind::nodes)
        convert_node(tree, "AB"[side], *numbers[side]);
      else
        check_triangle(tree, "AB"[side], *numbers[side]);
    }
  }
  void convert_node(std::uint32_t tree, char side, std::uint32_t& id) const {
    const auto& table = node_of_[tree];
    const std::size_t size = out_.trees[tree].size();
    if (table.empty() && id < size) return;
    const auto found = std::lower_bound(table.begin(), table.end(), std::pair(id, std::uint32_t{0}));
    if (found == table.end() || found->first != id)
      fail("expected a node of tree " + text(out_.trees[tree].id) + " (" + side + "), which has " +
           text(size) + " nodes, found id " + text(id) + "; use the ids of the tree's description");
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
             text(out_.trees[tree].id_of(nodes[side])) + " of " + "AB"[side] +
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

  std::span<const std::byte> bytes_;
  std::string name_;
  std::uint32_t first_, last_;
  Capture out_;

  // The current chunk, and where in it.
  std::size_t begin_ = 0, at_ = 0, end_ = 0, chunk_ = 0;
  std::string kind_;
  std::uint64_t ticks_ = 0;
  std::uint32_t query_ = 0;  ///< its number; 0: none
  std::uint64_t event_ = 0;  ///< for messages, from 1; 0: none

  bool synced_ = false;
  std::uint64_t first_ticks_ = 0, first_wall_ = 0, last_ticks_ = 0, last_wall_ = 0;
  std::unordered_map<std::uint32_t, std::uint32_t> names_, meshes_, trees_;  ///< index by id
  /// By tree: (id, node), sorted; empty if ids are our numbers.
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> node_of_;
  std::unordered_map<std::uint32_t, Growing> queries_;

  // Of a stream.
  bool streaming_ = false;
  std::uint64_t base_ = 0;        ///< offset of bytes_
  std::uint32_t last_begun_ = 0;  ///< greatest number of a query that began
  std::uint32_t ended_ = 0;       ///< the query that the current chunk ends; 0: none
};

std::size_t Tree::numbers() const {
  return numbers_of(static_cast<std::uint32_t>(volume), directions.size());
}

bool is_capture(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

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
