#pragma once
/// The LRB-rep: a body as a complex of cells (C. Gonzalez-Ochoa, "2-Body Collision Detection using LRB-reps",
/// section 2).
///
/// The cells are the *solid*, the *outside* and the *regions* between them. Every face has one cell on each
/// side: its inner cell behind it and its outer cell in front of it (on the side that its normal points to;
/// its corners run counter-clockwise seen from there). *Real* faces, those of the mesh, have the solid behind
/// them; *pseudo* faces have a region behind them and hide what is in it. A region's *face-collector* lists
/// its faces: its *lids* (the faces that it lies behind) and its *floor* (the faces that it lies in front
/// of). A region may have zero volume.
///
/// An LRB-rep does not change once built, so that threads and bodies can share one. Its levels are made by
/// the first request for them, and shared by all copies.
///
/// It departs from the paper in one point: each face keeps an "inner" and an "outer" cell instead of an
/// unordered pair, which costs nothing and makes "which cell hides which" a look-up. A mesh that cannot be
/// abstracted (open, non-manifold) is held as an LRB-rep without regions: it can be queried exactly, but only
/// a closed one has an inside.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/ids.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/simplex_view.hpp>

namespace lrb {

/// The plain arrays of an LRB-rep: what a builder fills in and a file stores.
struct LrbData {
  int dim = 3;
  std::vector<Eigen::Vector3d> vertices;          ///< (|V| x 3): the mesh's, then those of pseudo faces
  std::vector<std::uint32_t> face_offsets = {0};  ///< (|F| + 1)
  std::vector<VertexId> face_vertices;
  std::uint32_t real_face_count = 0;  ///< faces [0, real_face_count) are real, in the mesh's order
  std::vector<CellId> inner_cell;     ///< (|F|): kSolid (real) or a region (pseudo)
  std::vector<CellId> outer_cell;     ///< (|F|): a region or kOutside
  /// (|R|): the builder's pass that made the region; 0 lies on the solid.
  std::vector<std::uint16_t> region_layer;
  bool closed = false;             ///< the real faces bound a solid, so that "inside" has a meaning
  bool self_intersecting = false;  ///< the solid overlaps itself ("inside" is then by parity)
  std::string name;

  std::size_t face_count() const { return face_offsets.size() - 1; }
  std::span<const VertexId> face(FaceId f) const {
    return {face_vertices.data() + face_offsets[f], face_offsets[f + 1] - face_offsets[f]};
  }
};

class WrapperLevels;

/// Returns the FNV-1a hash (64 bits) of all members but the name.
std::uint64_t hash_of(const LrbData& data);

class LrbRep {
 public:
  /// Checks the arrays against each other (throws InputError naming the element) and derives collectors,
  /// parents and the query's tree, the tree on `threads` threads (see BuildOptions).
  explicit LrbRep(LrbData data, unsigned threads = 1);
  /// Does the same, given what takes long to derive: the tree's nodes and blocks, and hash_of(data), as they
  /// were stored. Both are checked only as far as safety requires (see ObbTree); the caller vouches that they
  /// belong to the data.
  LrbRep(LrbData data, std::vector<TreeNode> nodes, std::vector<LeafBlock> blocks, std::uint64_t hash);
  /// Makes a body without regions: its outermost wrapper is the body itself. `closed` is as check_mesh()
  /// finds it.
  static LrbRep without_regions(const Mesh& mesh, bool closed, bool self_intersecting);
  /// Makes a body of the real faces of another one, without regions. Faces and vertices keep their numbers.
  static LrbRep without_regions(const LrbRep& rep);

  int dim() const { return d_.dim; }
  bool closed() const { return d_.closed; }
  /// Returns what the data says. The build of regions finds it; of a body without regions it need not be
  /// known.
  bool self_intersecting() const { return d_.self_intersecting; }
  /// Returns true if faces cross, or cover each other in one plane and face the same way (find_overlaps() in
  /// engine/mesh/self_intersections.hpp), whoever made the body. Of one without regions, the first call finds
  /// it out; other threads that call wait for it.
  bool overlaps_itself() const;
  const std::string& name() const { return d_.name; }
  const LrbData& data() const { return d_; }

  std::span<const Eigen::Vector3d> vertices() const { return d_.vertices; }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(d_.face_count()); }
  std::uint32_t real_face_count() const { return d_.real_face_count; }
  bool is_real(FaceId f) const { return f < d_.real_face_count; }
  std::span<const VertexId> face(FaceId f) const { return d_.face(f); }
  CellId inner_cell(FaceId f) const { return d_.inner_cell[f]; }
  CellId outer_cell(FaceId f) const { return d_.outer_cell[f]; }
  /// Returns one real vertex of each connected piece of the real surface (pieces joined by a vertex count as
  /// one).
  std::span<const VertexId> component_vertices() const { return component_vertices_; }
  /// Returns the faces that have the outside in front of them: the boundary of the outermost wrapper.
  std::span<const FaceId> outermost_faces() const { return outermost_; }

  std::uint32_t region_count() const { return static_cast<std::uint32_t>(d_.region_layer.size()); }
  /// Returns all faces of a region: its lids, then its floor.
  std::span<const FaceId> collector(RegionId r) const {
    return {collector_faces_.data() + collector_offsets_[r],
            collector_offsets_[r + 1] - collector_offsets_[r]};
  }
  /// Returns the faces that hide the region (it is their inner cell).
  std::span<const FaceId> lids(RegionId r) const { return collector(r).first(lid_count_[r]); }
  /// Returns the faces that the region hides (it is their outer cell).
  std::span<const FaceId> floor(RegionId r) const { return collector(r).subspan(lid_count_[r]); }
  std::uint16_t layer(RegionId r) const { return d_.region_layer[r]; }
  /// Returns the number of the builder's passes: 1 + the largest layer, 0 without regions.
  std::uint32_t layer_count() const { return layer_count_; }
  /// Returns the outer neighbour (a region or kOutside) with which the region shares the most lid area.
  CellId parent(RegionId r) const { return parent_[r]; }
  /// Returns the number of steps from the outside along parents: 1 for a region whose parent is the outside.
  std::uint32_t depth(RegionId r) const { return depth_[r]; }

  /// Simplices: the triangles of each face's fan from its first corner (2D: its segment), numbered face by
  /// face, so that those of real faces come first and in the order of the mesh's file.
  std::uint32_t simplex_count() const;
  std::uint32_t real_simplex_count() const;
  bool is_real_simplex(SimplexId s) const { return is_real(face_of_simplex(s)); }
  /// Returns the number of corners of a simplex: 3, or 2 in 2D.
  int simplex_size() const { return d_.dim; }
  FaceId face_of_simplex(SimplexId s) const {
    return s < whole_faces_ ? FaceId(s.value()) : face_of_simplex_[s];
  }
  SimplexId first_simplex(FaceId f) const {
    // a fan has two triangles less than corners
    return SimplexId(f < whole_faces_ ? f.value() : d_.face_offsets[f] - 2 * f);
  }
  /// Writes the simplex's corners (3, or 2 in 2D) to out.
  void simplex(SimplexId s, VertexId out[3]) const {
    if (s < whole_faces_) {
      const VertexId* corners = d_.face_vertices.data() + static_cast<std::size_t>(d_.dim) * s;
      out[0] = corners[0];
      out[1] = corners[1];
      if (d_.dim == 3) out[2] = corners[2];
      return;
    }
    const FaceId f = face_of_simplex(s);
    const VertexId* corners = d_.face_vertices.data() + d_.face_offsets[f];
    const std::uint32_t i = s - first_simplex(f);
    out[0] = corners[0];
    out[1] = corners[i + 1];
    out[2] = corners[i + 2];
  }

  /// Returns the simplices as the tree sees them; the view refers to this LRB-rep.
  SimplexView simplices() const;
  const ObbTree& tree() const { return tree_; }
  /// Returns the levels that coarse queries walk (wrapper.hpp). They come from the file, or are made by
  /// the first call, which takes time of the order of building; other threads that call wait for it.
  /// `threads`: 1 inside work that is shared among threads already.
  const WrapperLevels& levels(unsigned threads = 1) const;
  /// Returns true if the levels are there already.
  bool has_levels() const;
  /// Takes levels made for this LRB-rep, as a file stored them.
  void keep_levels(WrapperLevels levels);
  /// Returns hash_of(data()), which identifies this very complex in traces and files.
  std::uint64_t hash() const { return hash_; }
  /// Returns a number that differs between any two LRB-reps made in this process (copies share it), so that
  /// caches notice a new body at an old address.
  std::uint64_t serial() const { return serial_; }
  /// Returns the memory held by all arrays and the tree, in bytes.
  std::size_t memory_bytes() const;

 private:
  struct MadeLevels;
  struct FoundOverlap;

  void derive();
  void link_faces_to_regions();
  void find_parents();
  void find_components();

  LrbData d_;
  std::vector<FaceId> outermost_;
  std::vector<VertexId> component_vertices_;
  std::vector<std::uint32_t> collector_offsets_;  ///< (|R| + 1)
  std::vector<FaceId> collector_faces_;
  std::vector<std::uint32_t> lid_count_;  ///< (|R|)
  std::vector<CellId> parent_;            ///< (|R|)
  std::vector<std::uint32_t> depth_;      ///< (|R|)
  std::uint32_t whole_faces_ = 0;         ///< this many faces, counted from the first, are one simplex each
  std::vector<FaceId> face_of_simplex_;   ///< (simplices) empty if every face is one simplex
  std::uint32_t layer_count_ = 0;
  std::uint64_t hash_ = 0;
  std::uint64_t serial_ = 0;
  ObbTree tree_;
  std::shared_ptr<MadeLevels> levels_;
  std::shared_ptr<FoundOverlap> overlap_;
};

/// The version of the file format that save_lrb writes, and the newest that load_lrb reads.
inline constexpr std::uint32_t kLrbFileVersion = 3;

/// Writes an LRB-rep to a binary file (`.lrb`): magic, version, the arrays of LrbData, each preceded by its
/// length, their hash, the query's tree, the levels if they were made (LrbRep::levels()), and a checksum of
/// everything before it (lrb_checksum()); little-endian. Version 2 had no levels; version 1 had neither hash
/// nor tree, and FNV-1a as its checksum. The file appears whole or not at all. Throws EnvironmentError or
/// InputError as AtomicFile does.
void save_lrb(const LrbRep& rep, const std::string& path);

/// Reads an LRB-rep from a `.lrb` file of this version or an older one. If the checksum is right, trees are
/// trusted to be those that were stored: their structure is checked, their bounds only by validate(). So are
/// levels: which faces each has follows from how thick its regions are said to be, and it is checked that it
/// encloses the body; that no region is thicker is found by validate() alone. A file that lies about it gets
/// an error bound that is too small, never a wrong relation. Throws InputError if the file is damaged, cut
/// short, of a newer version or not a `.lrb` file at all. Lengths are checked against the file's size before
/// memory is allocated.
LrbRep load_lrb(const std::string& path);

/// Does the same from memory; `name` stands for the file in messages.
LrbRep load_lrb(std::string_view bytes, const std::string& name);

/// Returns the checksum that a file of this version holds in its last eight bytes, computed over the bytes
/// before.
std::uint64_t lrb_checksum(std::string_view bytes, std::uint32_t version = kLrbFileVersion);

/// Returns true if bytes begin like a `.lrb` file.
bool looks_like_lrb(std::string_view bytes);

}  // namespace lrb
