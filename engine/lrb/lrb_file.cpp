#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {
namespace {

/// As in PNG, a non-ASCII byte and line ends reveal a file that was transferred as text.
constexpr std::string_view kMagic("\x89LRB\r\n\x1a\n", 8);

/// The first versions that contain the hash and the tree, and levels of detail.
constexpr std::uint32_t kFirstWithTree = 2, kFirstWithLevels = 3;
/// The last versions that took all polygons, and those of pseudo faces, as fans.
constexpr std::uint32_t kLastWithFans = 3, kLastWithFanLids = 4;

class Writer {
 public:
  template <class T>
  void value(const T& x) {
    bytes_.append(reinterpret_cast<const char*>(&x), sizeof x);
  }
  template <class T>
  void array(const T* x, std::size_t count) {
    value(static_cast<std::uint64_t>(count));
    bytes_.append(reinterpret_cast<const char*>(x), count * sizeof(T));
  }
  template <class T>
  void array(const std::vector<T>& x) {
    array(x.data(), x.size());
  }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// The checksum of a version: since version 2 by words, at memory bandwidth; in version 1 byte by byte
/// (FNV-1a).
class Checksum {
 public:
  explicit Checksum(std::uint32_t version) : by_words_(version >= kFirstWithTree) {}
  void add(std::string_view bytes) {
    by_words_ ? words_.add_bytes(bytes.data(), bytes.size()) : bytes_.add_bytes(bytes.data(), bytes.size());
  }
  std::uint64_t value() const { return by_words_ ? words_.value() : bytes_.value(); }

 private:
  bool by_words_;
  WordSums words_;
  Fnv64 bytes_;
};

/// A value in a file, which is not aligned.
template <class T>
struct Packed {
  char bytes[sizeof(T)];
  operator T() const {
    T x;
    std::memcpy(static_cast<void*>(&x), bytes, sizeof x);
    return x;
  }
};

/// Reads the fields of a file, from memory or chunk by chunk from the file itself, so that its arrays are in
/// memory only once. Verifies the checksum before it reports any other fault.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name)
      : name_(name), size_(bytes.size()), chunk_(bytes), unread_(bytes), chunk_end_(bytes.size()) {}
  Reader(InputFile& file, const std::string& name)
      : name_(name), size_(*file.size()), file_(&file), buffer_(kChunk, '\0') {
    if (size_ > 0) next_chunk();
  }

  /// Reads the magic and the version, and returns the version.
  std::uint32_t begin() {
    if (!looks_like_lrb(unread_))
      throw InputError(printable_name(name_) +
                       ": byte 0: expected a .lrb file; build one with `lrbscope build MESH -o FILE.lrb`");
    unread_.remove_prefix(kMagic.size());
    std::uint32_t version;
    if (size_ < at() + sizeof version) fail("the file ends in the middle of a number");
    take(&version, sizeof version);
    if (version > kLrbFileVersion)
      throw InputError(printable_name(name_) + ": byte 8: found file version " + std::to_string(version) +
                       ", expected at most " + std::to_string(kLrbFileVersion) + "; use a newer lrbscope");
    if (size_ < at() + kChecksum) fail("the file is truncated");
    sum_ = Checksum(version);
    return version;
  }

  template <class T>
  T value() {
    if (size_ - at() < sizeof(T)) reject("the file ends in the middle of a number");
    T x;
    take(&x, sizeof x);
    return x;
  }

  template <class T>
  std::vector<T> array() {
    const auto count = value<std::uint64_t>();
    // Division avoids the overflow of count * sizeof(T). Checked before allocation, so that a damaged length
    // cannot exhaust the memory.
    if (count > (size_ - at()) / sizeof(T))
      reject("an array of " + std::to_string(count) + " elements exceeds the rest of the file");
    std::vector<T> x;
    x.reserve(count);
    for (;;) {
      // The elements that end in this chunk, then the one that continues in the next.
      const std::size_t whole = std::min<std::size_t>(count - x.size(), unread_.size() / sizeof(T));
      const auto* const first = reinterpret_cast<const Packed<T>*>(unread_.data());
      x.insert(x.end(), first, first + whole);
      unread_.remove_prefix(whole * sizeof(T));
      if (x.size() == count) return x;
      Packed<T> divided;
      take(divided.bytes, sizeof divided.bytes);
      x.push_back(divided);
    }
  }

  /// All fields have been read.
  void end() {
    if (at() + kChecksum != size_) reject("there are bytes after the end of the .lrb data");
    verify();
  }

  /// Throws InputError: the checksum does not match or, if it does, this fault at the next byte.
  [[noreturn]] void reject(const std::string& what) {
    const std::string found = at_byte(what);
    verify();
    throw InputError(found);
  }

 private:
  static constexpr std::size_t kChecksum = sizeof(std::uint64_t), kChunk = std::size_t{1} << 18;

  std::size_t at() const { return chunk_end_ - unread_.size(); }
  std::string at_byte(const std::string& what) const {
    return printable_name(name_) + ": byte " + std::to_string(at()) + ": " + what +
           "; rebuild it from its mesh";
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(at_byte(what)); }

  void take(void* to, std::size_t size) {
    for (auto* out = static_cast<char*>(to); size > 0;) {
      if (unread_.empty()) next_chunk();
      const std::size_t part = std::min(size, unread_.size());
      std::memcpy(out, unread_.data(), part);
      unread_.remove_prefix(part);
      out += part, size -= part;
    }
  }

  void next_chunk() {
    sum_chunk();
    const std::size_t got = file_ != nullptr ? file_->read(buffer_.data(), kChunk) : 0;
    if (got == 0) fail("the file became shorter while it was read");
    chunk_ = unread_ = std::string_view(buffer_).substr(0, got);
    chunk_end_ += got;
  }

  /// Adds a chunk to the checksum of all bytes but the last ones, which are the stored one.
  void sum_chunk() {
    const std::size_t before = chunk_end_ - chunk_.size(), last = size_ - kChecksum;
    const std::size_t summed = std::min(chunk_.size(), last - std::min(last, before));
    sum_.add(chunk_.substr(0, summed));
    stored_.append(chunk_.substr(summed));
  }

  void verify() {
    while (chunk_end_ < size_) next_chunk();
    sum_chunk();
    unread_ = {};
    const std::uint64_t sum = sum_.value();
    if (stored_ != std::string_view(reinterpret_cast<const char*>(&sum), sizeof sum))
      fail("the checksum does not match: the file is damaged or truncated");
  }

  const std::string& name_;
  std::size_t size_;
  InputFile* file_ = nullptr;
  std::string buffer_;
  std::string_view chunk_, unread_;  ///< the chunk in memory, and its part that is not read yet
  std::size_t chunk_end_ = 0;        ///< position in the file
  Checksum sum_{kLrbFileVersion};
  std::string stored_;
};

/// Writes a flag for the presence of levels of detail, then the parts that take long to compute.
void write_levels(const LrbRep& rep, Writer& w) {
  w.value(static_cast<std::uint32_t>(rep.has_levels()));
  if (!rep.has_levels()) return;
  // The tolerances and the trees take long to compute. The faces of each level follow from the tolerances.
  const WrapperLevels& levels = rep.levels();
  w.array(levels.needed().data(), levels.needed().size());
  w.value(static_cast<std::uint64_t>(levels.all().size()));
  for (const WrapperLevel& level : levels.all()) {
    w.value(level.bound);
    w.array(level.tree.nodes());
    w.array(level.tree.blocks());
  }
}

struct StoredLevels {
  std::vector<double> needed;
  std::vector<WrapperLevels::StoredLevel> levels;
};

std::optional<StoredLevels> read_levels(Reader& r) {
  const auto there = r.value<std::uint32_t>();
  if (there > 1) r.reject("the flag for levels is neither 0 nor 1");
  if (there == 0) return std::nullopt;
  StoredLevels s;
  s.needed = r.array<double>();
  for (auto count = r.value<std::uint64_t>(); count > 0; --count) {
    WrapperLevels::StoredLevel& level = s.levels.emplace_back();
    level.bound = r.value<double>();
    level.nodes = r.array<TreeNode>();
    level.blocks = r.array<LeafBlock>();
  }
  return s;
}

}  // namespace

bool looks_like_lrb(std::string_view bytes) {
  return bytes.substr(0, kMagic.size()) == kMagic;
}

std::uint64_t lrb_checksum(std::string_view bytes, std::uint32_t version) {
  Checksum sum(version);
  sum.add(bytes);
  return sum.value();
}

void save_lrb(const LrbRep& rep, const std::string& path) {
  const LrbData& d = rep.data();
  Writer w;
  // Header, then the complex, then data derived from it, then the checksum of everything before it.
  w.bytes().append(kMagic);
  w.value(rep.has_cut_lids() ? kLrbFileVersion : rep.has_cut_faces() ? kLastWithFanLids : kLastWithFans);
  w.value(static_cast<std::uint32_t>(d.dim));
  w.value(d.real_face_count);
  w.value(static_cast<std::uint32_t>(d.closed) | static_cast<std::uint32_t>(d.self_intersecting) << 1);
  w.array(d.name.data(), d.name.size());
  w.array(d.vertices);
  w.array(d.face_offsets);
  w.array(d.face_vertices);
  w.array(d.inner_cell);
  w.array(d.outer_cell);
  w.array(d.region_layer);
  // Derived data: stored because computing it takes longer than reading it.
  w.value(rep.hash());
  w.array(rep.tree().nodes());
  w.array(rep.tree().blocks());
  write_levels(rep, w);
  w.value(lrb_checksum(w.bytes()));
  // Written atomically, so that no reader finds an incomplete file.
  write_file(path, w.bytes());
}

namespace {

LrbRep load(Reader r, const std::string& name) {
  const std::uint32_t version = r.begin();
  // The complex, field by field in the order of save_lrb().
  LrbData d;
  d.dim = static_cast<int>(r.value<std::uint32_t>());
  d.real_face_count = r.value<std::uint32_t>();
  const auto flags = r.value<std::uint32_t>();
  d.closed = flags & 1u;
  d.self_intersecting = flags & 2u;
  const std::vector<char> stored_name = r.array<char>();
  d.name.assign(stored_name.begin(), stored_name.end());
  d.vertices = r.array<Eigen::Vector3d>();
  d.face_offsets = r.array<std::uint32_t>();
  d.face_vertices = r.array<VertexId>();
  d.inner_cell = r.array<CellId>();
  d.outer_cell = r.array<CellId>();
  d.region_layer = r.array<std::uint16_t>();
  // Derived data, as far as the version contains it. Missing parts are computed.
  const bool with_tree = version >= kFirstWithTree;
  const auto hash = with_tree ? r.value<std::uint64_t>() : 0;
  auto nodes = with_tree ? r.array<TreeNode>() : std::vector<TreeNode>();
  auto blocks = with_tree ? r.array<LeafBlock>() : std::vector<LeafBlock>();
  auto levels = version >= kFirstWithLevels ? read_levels(r) : std::nullopt;
  // LrbData::face_count() subtracts 1 from the number of offsets.
  if (d.face_offsets.empty()) r.reject("the offsets of the faces are missing");
  r.end();
  try {
    // The constructors check the structure: indices, cells, the shape of the trees, the order of the levels.
    LrbRep rep =
        with_tree ? LrbRep(std::move(d), std::move(nodes), std::move(blocks), hash) : LrbRep(std::move(d));
    // The regions, tree and levels of such a file belong to the fans.
    if ((version <= kLastWithFans && rep.has_cut_faces()) ||
        (version <= kLastWithFanLids && rep.has_cut_lids()))
      return LrbRep::without_regions(rep, true);
    if (levels) rep.keep_levels(WrapperLevels(rep, std::move(levels->needed), std::move(levels->levels)));
    return rep;
  } catch (const InputError& e) {
    throw InputError(printable_name(name) + ": " + e.what());
  }
}

}  // namespace

LrbRep load_lrb(std::string_view bytes, const std::string& name) {
  return load(Reader(bytes, name), name);
}

LrbRep load_lrb(const std::string& path) {
  InputFile file(path);
  return load_lrb(file);
}

LrbRep load_lrb(InputFile& file) {
  // A pipe has no size, which lengths in the file are compared with.
  return file.size() ? load(Reader(file, file.path()), file.path())
                     : load_lrb(std::string_view(read_file(file)), file.path());
}

}  // namespace lrb
