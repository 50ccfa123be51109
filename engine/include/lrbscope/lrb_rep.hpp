#pragma once
/// The LRB-rep: a body as a complex of cells (C. Gonzalez-Ochoa, "2-Body Collision Detection using LRB-reps",
/// section 2).
///
/// The cells are the *solid*, the *outside* and the *regions* between them. Every face has an inner cell
/// behind it and an outer cell in front of it. Front is the side that its normal points to, from which its
/// corners run counter-clockwise. *Real* faces, those of the mesh, have the solid behind them. *Pseudo* faces
/// have a region behind them and hide its contents. The *face-collector* of a region lists its faces: its
/// *lids* (the region is behind them) and its *floor* (the region is in front of them). A region may have
/// zero volume.
///
/// An LRB-rep is immutable, so that threads and bodies can share one. Its levels of detail are created on
/// first use and shared by all copies.
///
/// It differs from the paper in one point: each face stores an inner and an outer cell instead of an
/// unordered pair, so that "which cell hides which" is a look-up at no extra cost. A mesh for which no
/// regions can be built (open, non-manifold) becomes an LRB-rep without regions. It can be queried exactly,
/// but only a closed one has an inside.

#include <array>
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

class InputFile;

/// The plain arrays of an LRB-rep, as filled in by a builder and stored in a file.
struct LrbData {
  int dim = 3;
  std::vector<Eigen::Vector3d> vertices;  ///< (|V| x 3): those of the mesh, then those of pseudo faces
  std::vector<std::uint32_t> face_offsets = {0};  ///< (|F| + 1)
  std::vector<VertexId> face_vertices;
  std::uint32_t real_face_count = 0;  ///< faces [0, real_face_count) are real, in the mesh's order
  std::vector<CellId> inner_cell;     ///< (|F|): kSolid (real) or a region (pseudo)
  std::vector<CellId> outer_cell;     ///< (|F|): a region or kOutside
  /// (|R|): number of the builder's pass that made the region; layer 0 is next to the solid.
  std::vector<std::uint16_t> region_layer;
  bool closed = false;             ///< the real faces bound a solid, so that "inside" is defined
  bool self_intersecting = false;  ///< the solid overlaps itself ("inside" is then decided by parity)
  std::string name;

  std::size_t face_count() const { return face_offsets.size() - 1; }
  std::span<const VertexId> face(FaceId f) const {
    return {face_vertices.data() + face_offsets[f], face_offsets[f + 1] - face_offsets[f]};
  }
};

class SurfaceGraph;
class WrapperLevels;

/// Returns the FNV-1a hash (64 bits) of all members except the name.
std::uint64_t hash_of(const LrbData& data);

class LrbRep {
 public:
  /// Checks the consistency of the arrays and derives collectors, parents and the OBB tree, which is built on
  /// `threads` threads (see BuildOptions). Throws InputError naming the inconsistent element.
  explicit LrbRep(LrbData data, unsigned threads = 1);
  /// Constructs from stored results as well: the tree's nodes and blocks, and hash_of(data). These are
  /// checked only as far as memory safety requires (see ObbTree). The caller guarantees that they belong to
  /// the data.
  LrbRep(LrbData data, std::vector<TreeNode> nodes, std::vector<LeafBlock> blocks, std::uint64_t hash);
  /// Creates a body without regions: its outermost wrapper is its own surface. `closed`: as check_mesh()
  /// reports. `threads`: as for the constructor.
  static LrbRep without_regions(const Mesh& mesh, bool closed, bool self_intersecting, unsigned threads = 1);
  /// Creates a body without regions from the real faces of another. Faces and vertices keep their numbers.
  /// `dropped_fans`: what dropped_fans() is to return.
  static LrbRep without_regions(const LrbRep& rep, bool dropped_fans = false);

  /// Returns the mesh: the real faces and the vertices up to the last one that they use, with their numbers.
  Mesh real_mesh() const;

  int dim() const { return d_.dim; }
  bool closed() const { return d_.closed; }
  /// Returns LrbData::self_intersecting, which is determined when regions are built. It may be unset for a
  /// body without regions: use overlaps_itself() for those.
  bool self_intersecting() const { return d_.self_intersecting; }
  /// Returns true if two real faces cross, or overlap in one plane with the same orientation (find_overlaps()
  /// in engine/mesh/self_intersections.hpp). For a body without regions the first call computes it, and
  /// concurrent calls wait.
  bool overlaps_itself() const;
  const std::string& name() const { return d_.name; }
  void rename(std::string name) { d_.name = std::move(name); }
  const LrbData& data() const { return d_; }

  std::span<const Eigen::Vector3d> vertices() const { return d_.vertices; }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(d_.face_count()); }
  std::uint32_t real_face_count() const { return d_.real_face_count; }
  bool is_real(FaceId f) const { return f < d_.real_face_count; }
  std::span<const VertexId> face(FaceId f) const { return d_.face(f); }
  CellId inner_cell(FaceId f) const { return d_.inner_cell[f]; }
  CellId outer_cell(FaceId f) const { return d_.outer_cell[f]; }
  /// Returns one real vertex of each connected component of the real surface. Components that share a vertex
  /// count as one.
  std::span<const VertexId> component_vertices() const { return component_vertices_; }
  /// Returns the faces whose outer cell is the outside: the boundary of the outermost wrapper.
  std::span<const FaceId> outermost_faces() const { return outermost_; }

  std::uint32_t region_count() const { return static_cast<std::uint32_t>(d_.region_layer.size()); }
  /// Returns all faces of a region: its lids, then its floor.
  std::span<const FaceId> collector(RegionId r) const {
    return {collector_faces_.data() + collector_offsets_[r],
            collector_offsets_[r + 1] - collector_offsets_[r]};
  }
  /// Returns the faces that hide the region (their inner cell is the region).
  std::span<const FaceId> lids(RegionId r) const { return collector(r).first(lid_count_[r]); }
  /// Returns the faces that the region hides (their outer cell is the region).
  std::span<const FaceId> floor(RegionId r) const { return collector(r).subspan(lid_count_[r]); }
  std::uint16_t layer(RegionId r) const { return d_.region_layer[r]; }
  /// Returns the number of passes of the builder: 1 + the largest layer, or 0 without regions.
  std::uint32_t layer_count() const { return layer_count_; }
  /// Returns the outer neighbour (a region or kOutside) with which the region shares the largest lid area.
  CellId parent(RegionId r) const { return parent_[r]; }
  /// Returns the number of steps to the outside along parents: 1 for a region whose parent is the outside.
  std::uint32_t depth(RegionId r) const { return depth_[r]; }

  /// Return the number of simplices. Simplices are the triangles of each face (cut_polygon(); of a pseudo
  /// face that is planar and convex, without degenerate ones; 2D: its segment), numbered face by face. Those
  /// of real faces come first, in the order of the mesh file.
  std::uint32_t simplex_count() const;
  std::uint32_t real_simplex_count() const;
  bool is_real_simplex(SimplexId s) const { return is_real(face_of_simplex(s)); }
  /// Returns the number of corners of a simplex: 3, or 2 in 2D.
  int simplex_size() const { return d_.dim; }
  FaceId face_of_simplex(SimplexId s) const {
    return s < whole_faces_ ? FaceId(s.value()) : face_of_simplex_[s];
  }
  SimplexId first_simplex(FaceId f) const {
    // A polygon has two triangles fewer than corners.
    return SimplexId(f < whole_faces_ ? f.value() : d_.face_offsets[f] - 2 * f);
  }
  /// Writes the corners of a simplex (3, or 2 in 2D) to out.
  void simplex(SimplexId s, VertexId out[3]) const {
    if (s < whole_faces_) {
      const VertexId* corners = d_.face_vertices.data() + static_cast<std::size_t>(d_.dim) * s;
      out[0] = corners[0];
      out[1] = corners[1];
      if (d_.dim == 3) out[2] = corners[2];
      return;
    }
    if (!triangles_.empty()) {
      for (int i = 0; i < 3; ++i) out[i] = triangles_[s - whole_faces_][static_cast<std::size_t>(i)];
      return;
    }
    const FaceId f = face_of_simplex(s);
    const VertexId* corners = d_.face_vertices.data() + d_.face_offsets[f];
    const std::uint32_t i = s - first_simplex(f);
    out[0] = corners[0];
    out[1] = corners[i + 1];
    out[2] = corners[i + 2];
  }

  /// Return true if a face, or a pseudo face, is not the fan from its first corner (PolygonCut::ears).
  bool has_cut_faces() const { return !triangles_.empty(); }
  bool has_cut_lids() const { return has_cut_lids_; }
  /// Returns the real faces that are fans although these do not cover them (PolygonCut::folded).
  std::span<const FaceId> folded_faces() const { return folded_faces_; }
  /// Returns true if this was read from a file of an earlier version, which took all polygons as fans,
  /// although it has other ones: its regions do not fit the body and were left out.
  bool dropped_fans() const { return dropped_fans_; }

  /// Returns the view from which the tree is built; it refers to this LRB-rep.
  SimplexView simplices() const;
  const ObbTree& tree() const { return tree_; }
  /// Returns the levels of detail used by coarse queries (wrapper.hpp). They are loaded from the file or
  /// created by the first call, in about the time of a build; concurrent calls wait. Pass `threads` = 1 from
  /// within parallel work.
  const WrapperLevels& levels(unsigned threads = 1) const;
  /// Returns true if the levels of detail exist already.
  bool has_levels() const;
  /// Stores levels of detail that were created for this LRB-rep and loaded from a file.
  void keep_levels(WrapperLevels levels);
  /// Returns hash_of(data()), which identifies this complex in traces and files. The first call computes it,
  /// unless it was stored, and concurrent calls wait.
  std::uint64_t hash() const;
  /// Returns the edges of the real faces, for the engine itself. The first call collects them; concurrent
  /// calls wait.
  const SurfaceGraph& surface_graph() const;
  /// Returns a number that is unique among the LRB-reps created by this process (copies share it), so that
  /// caches detect a new body at an old address.
  std::uint64_t serial() const { return serial_; }
  /// Returns the memory used by all arrays and the tree, in bytes.
  std::size_t memory_bytes() const;

 private:
  struct MadeLevels;
  struct FoundOverlap;
  struct FoundGraph;
  struct FoundHash;

  void derive();
  void cut_polygons();
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
  std::uint32_t whole_faces_ = 0;         ///< faces [0, whole_faces_) consist of one simplex each
  std::vector<FaceId> face_of_simplex_;   ///< (simplices) empty if every face is one simplex
  /// (simplices after those of whole faces); empty if all faces are fans.
  std::vector<std::array<VertexId, 3>> triangles_;
  std::vector<FaceId> folded_faces_;
  bool dropped_fans_ = false, has_cut_lids_ = false;
  std::uint32_t layer_count_ = 0;
  std::uint64_t serial_ = 0;
  ObbTree tree_;
  std::shared_ptr<MadeLevels> levels_;
  std::shared_ptr<FoundOverlap> overlap_;
  std::shared_ptr<FoundGraph> graph_;
  std::shared_ptr<FoundHash> hash_;
};

/// The version of the file format that save_lrb() writes, and the newest one that load_lrb() reads. Files of
/// bodies without pseudo faces that are not fans are also those of version 4, and those without any such
/// polygons those of version 3. They are written as such.
inline constexpr std::uint32_t kLrbFileVersion = 5;

/// Writes an LRB-rep to a binary file (`.lrb`), little-endian: magic, version, the arrays of LrbData, each
/// preceded by its length, their hash, the OBB tree, the levels of detail if they exist
/// (LrbRep::has_levels()), and a checksum of all preceding bytes (lrb_checksum()). Version 4 took
/// pseudo faces as fans, version 3 all polygons (LrbRep::dropped_fans()). Version 2 had no levels. Version 1
/// had no levels, hash or tree, and used FNV-1a as its checksum. The write is atomic. Throws EnvironmentError
/// or InputError as AtomicFile does.
void save_lrb(const LrbRep& rep, const std::string& path);

/// Reads an LRB-rep from a `.lrb` file of this version or an older one. Throws InputError if the file is
/// damaged, truncated, of a newer version or not a `.lrb` file. Lengths are checked against the file size
/// before memory is allocated.
///
/// If the checksum is right, the stored results are trusted as follows:
/// - Trees: the structure is checked here, the bounds only by validate().
/// - Levels of detail: their faces follow from the stored thicknesses. Each level is checked to enclose the
///   body. Only validate() checks that no region is thicker than stored. A wrong thickness leads to an error
///   bound that is too small, never to a wrong relation.
LrbRep load_lrb(const std::string& path);
LrbRep load_lrb(InputFile& file);

/// Reads an LRB-rep from memory. `name` replaces the path in messages.
LrbRep load_lrb(std::string_view bytes, const std::string& name);

/// Returns the checksum that a file of this version contains in its last eight bytes. `bytes`: all bytes
/// before those.
std::uint64_t lrb_checksum(std::string_view bytes, std::uint32_t version = kLrbFileVersion);

/// Returns true if `bytes` begin with the magic of a `.lrb` file.
bool looks_like_lrb(std::string_view bytes);

}  // namespace lrb
