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

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[noreturn]] void reject(const std::string& what) const {
    throw InputError(printable_name(name_) + ": byte " + std::to_string(at_) + ": " + what +
                     "; rebuild it from its mesh");
  }

  template <class T>
  T value() {
    // Values in a file are not aligned, so they are copied.
    need(sizeof(T));
    T x;
    std::memcpy(&x, bytes_.data() + at_, sizeof x);
    at_ += sizeof x;
    return x;
  }

  template <class T>
  std::vector<T> array() {
    const auto count = value<std::uint64_t>();
    // Division avoids the overflow of count * sizeof(T). Checked before allocation, so that a damaged length
    // cannot exhaust the memory.
    if (count > (bytes_.size() - at_) / sizeof(T))
      reject("an array of " + std::to_string(count) + " elements exceeds the rest of the file");
    std::vector<T> x(count);
    if (count != 0) std::memcpy(static_cast<void*>(x.data()), bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
    return x;
  }

  std::size_t at() const { return at_; }

 private:
  void need(std::size_t size) const {
    if (bytes_.size() - at_ < size) reject("the file ends in the middle of a number");
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = kMagic.size();
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

std::uint64_t lrb_checksum(std::string_view bytes, std::uint32_t version) {
  // Since version 2 by words, at memory bandwidth; in version 1 byte by byte (FNV-1a).
  if (version >= kFirstWithTree) return fnv64_of_words(bytes.data(), bytes.size());
  Fnv64 h;
  h.add_bytes(bytes.data(), bytes.size());
  return h.value();
}

void save_lrb(const LrbRep& rep, const std::string& path) {
  const LrbData& d = rep.data();
  Writer w;
  // Header, then the complex, then data derived from it, then the checksum of everything before it.
  w.bytes().append(kMagic);
  w.value(kLrbFileVersion);
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

bool looks_like_lrb(std::string_view bytes) {
  return bytes.substr(0, kMagic.size()) == kMagic;
}

LrbRep load_lrb(std::string_view bytes, const std::string& name) {
  if (!looks_like_lrb(bytes))
    throw InputError(printable_name(name) +
                     ": byte 0: expected a .lrb file; build one with `lrbscope build MESH -o FILE.lrb`");
  Reader r(bytes, name);
  // The version comes first: it determines the checksum and the fields that follow.
  const auto version = r.value<std::uint32_t>();
  if (version > kLrbFileVersion)
    throw InputError(printable_name(name) + ": byte 8: found file version " + std::to_string(version) +
                     ", expected at most " + std::to_string(kLrbFileVersion) + "; use a newer lrbscope");
  // The checksum is verified before any other field is interpreted.
  if (bytes.size() < r.at() + sizeof(std::uint64_t)) r.reject("the file is truncated");
  std::uint64_t stored;
  std::memcpy(&stored, bytes.data() + bytes.size() - sizeof stored, sizeof stored);
  if (stored != lrb_checksum(bytes.substr(0, bytes.size() - sizeof stored), version))
    r.reject("the checksum does not match: the file is damaged or truncated");
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
  if (r.at() + sizeof stored != bytes.size()) r.reject("there are bytes after the end of the .lrb data");
  // LrbData::face_count() subtracts 1 from the number of offsets.
  if (d.face_offsets.empty()) r.reject("the offsets of the faces are missing");
  try {
    // The constructors check the structure: indices, cells, the shape of the trees, the order of the levels.
    LrbRep rep =
        with_tree ? LrbRep(std::move(d), std::move(nodes), std::move(blocks), hash) : LrbRep(std::move(d));
    if (levels) rep.keep_levels(WrapperLevels(rep, std::move(levels->needed), std::move(levels->levels)));
    return rep;
  } catch (const InputError& e) {
    throw InputError(printable_name(name) + ": " + e.what());
  }
}

LrbRep load_lrb(const std::string& path) {
  return load_lrb(std::string_view(read_file(path)), path);
}

}  // namespace lrb
