#pragma once
/// A body for queries, created in one call from matrices, arrays, a mesh or a file. Faults are returned as an
/// error that names the element, not thrown.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb {

struct MadeBody;

struct BodyOptions {
  BuildOptions build;   ///< threads, quality (`lean`, `patch_interior`, `max_outer_faces`), seed, progress
  bool regions = true;  ///< false: faces only, without wrappers; takes a tenth of the time or less
  bool turn = true;     ///< reorient components that are inward-oriented; Body::notes() reports it
  /// When reading a file, merge coincident vertices where the surface is open (join_corners()).
  bool join = true;
  std::string name = "body";  ///< for messages about bodies that do not come from a file
};
/// Returns the default options.
const BodyOptions& default_body_options();

/// An immutable body that can be queried. Copies share the data and are cheap; give each thread its own.
/// Converts to `const LrbRep&`; the body must outlive every object that refers to it.
///
/// A surface that does not bound a solid (holes, edges with three faces, inconsistently oriented faces) is
/// valid: pairs, contacts and distances are exact as for any other body. Such a body has no wrappers, and
/// nothing is inside it: without surface contact, CollideResult::relation is `separate` if the world AABBs
/// are disjoint, else `undefined`. notes() gives the reason.
///
/// The cells of a body with regions are proven closed (validate_cells()). If that proof fails, for a mesh or
/// an .lrb file, the body consists of its faces only, and notes() gives the first violation.
class Body {
 public:
  /// Creates a body from a matrix of vertices (n x 3, or n x 2 for 2D; any scalar) and a matrix of faces (m x
  /// 3 triangles, m x k polygons with k corners, or m x 2 segments in 2D; any integer). Returns an error
  /// naming the index for coordinates that are not finite, for vertex indices out of range, and for faults
  /// that make a Mesh unusable.
  template <class V, class F>
  static Expected<Body> from(const Eigen::MatrixBase<V>& vertices, const Eigen::MatrixBase<F>& faces,
                             const BodyOptions& options = default_body_options());

  /// Creates a body from flat arrays: x, y, z of each vertex and three vertex indices of each triangle.
  static Expected<Body> from(std::span<const double> coordinates, std::span<const std::uint32_t> corners,
                             const BodyOptions& options = default_body_options());
  static Expected<Body> from(std::span<const double> coordinates, std::span<const std::int32_t> corners,
                             const BodyOptions& options = default_body_options());
  static Expected<Body> from(std::span<const double> coordinates, std::span<const std::int64_t> corners,
                             const BodyOptions& options = default_body_options());

  /// Creates a body from a mesh. Its name is used, unless it is empty.
  static Expected<Body> from(Mesh mesh, const BodyOptions& options = default_body_options());

  /// Creates a body from an LRB-rep. Reorients inward-oriented components, with a note, if it has no regions.
  static Body from(LrbRep rep);
  /// Wraps an existing LRB-rep, which may be shared. Never reorients it.
  static Body from(std::shared_ptr<const LrbRep> rep);

  /// Reads a mesh file as read_mesh() does, or an .lrb file; detected by content. Of the options of a build,
  /// an .lrb file uses `turn` and the threads alone.
  static Expected<Body> load(const std::string& path, const BodyOptions& options = default_body_options());

  const LrbRep& rep() const { return *impl_->rep; }
  operator const LrbRep&() const { return *impl_->rep; }

  const std::string& name() const { return rep().name(); }
  int dim() const { return rep().dim(); }
  /// Returns true if the surface bounds a solid, so that the relations "inside" and "separate" have a
  /// meaning.
  bool is_solid() const { return rep().closed(); }
  /// Returns true if the body has wrappers beyond its own surface. Bodies with few faces may need none.
  bool has_regions() const { return rep().region_count() > 0; }
  /// Returns the number of inward-oriented components that were reoriented.
  std::uint32_t turned() const { return impl_->turned; }
  /// Returns what was changed, and which queries are restricted and why; one line each, for users.
  std::span<const std::string> notes() const { return impl_->notes; }

  /// Returns true if both share the same data, as copies do.
  friend bool operator==(const Body& x, const Body& y) { return x.impl_ == y.impl_; }

 private:
  struct Impl {
    std::shared_ptr<const LrbRep> rep;
    std::vector<std::string> notes;
    std::uint32_t turned = 0;
  };

  explicit Body(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  /// `coordinates`: row-major, `each` per vertex. `corners`: row-major, `each_face` per face.
  static Expected<Body> from_rows(std::span<const double> coordinates, std::size_t each,
                                  std::span<const std::int64_t> corners, std::size_t each_face,
                                  const BodyOptions& options);
  static Body made(MadeBody made);

  std::shared_ptr<const Impl> impl_;
};

template <class V, class F>
Expected<Body> Body::from(const Eigen::MatrixBase<V>& vertices, const Eigen::MatrixBase<F>& faces,
                          const BodyOptions& options) {
  static_assert(Eigen::NumTraits<typename F::Scalar>::IsInteger, "faces are rows of vertex numbers");
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> v =
      vertices.template cast<double>();
  const Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> f =
      faces.template cast<std::int64_t>();
  return from_rows({v.data(), static_cast<std::size_t>(v.size())}, static_cast<std::size_t>(v.cols()),
                   {f.data(), static_cast<std::size_t>(f.size())}, static_cast<std::size_t>(f.cols()),
                   options);
}

// Conversion of an arbitrary mesh to an LRB-rep, with notes on the changes; used by lrb::Body and the
// command-line program.

struct MadeBody {
  LrbRep rep;
  std::vector<std::string> notes;  ///< changes and failures, one line each, for users
  double build_seconds = 0;        ///< 0 if no regions were built, or if they were in the cache
  std::uint32_t turned = 0;        ///< number of inward-oriented components
};

/// Reorients inward-oriented components, if `turn`, and builds an LRB-rep, or takes it from the folder
/// `options.cache`. A mesh without an LRB-rep, or with a failed proof, becomes a body without regions, and a
/// note gives the reason. Throws InputError if the mesh cannot be queried at all.
MadeBody make_body(CheckedMesh mesh, const BuildOptions& options, bool turn = true);

/// Creates a body without regions, for callers that need only pairs of faces, distances and the relation.
/// Proves only what these answers need. Faces keep their numbers. `threads`: see BuildOptions.
MadeBody make_body_of_faces(CheckedMesh mesh, bool turn = true, unsigned threads = 1);

/// Proves the cells of an LRB-rep; if that fails, takes its real faces without regions, and adds a note.
/// Without regions, reorients inward-oriented components, if `turn`.
MadeBody make_body(LrbRep rep, bool turn = true, unsigned threads = 1);

/// Checks a mesh and calls make_body() or make_body_of_faces(), as `options.regions` says.
MadeBody make_body(Mesh mesh, const BodyOptions& options);

/// Makes the body of a mesh file or an .lrb file, which is opened once and told by its content. `if_joined`
/// is appended to the note on merged vertices.
MadeBody make_body_of_file(const std::string& path, const BodyOptions& options,
                           std::string_view if_joined = {});

/// Returns a note with the first violation if the proof of an LRB-rep's cells fails (validate_cells()), or an
/// empty string if they are proven.
std::string note_unproven(const LrbRep& rep);
/// Returns a note on polygons that are not what their outlines say, or an empty string if there are none:
/// LrbRep::folded_faces(), LrbRep::dropped_fans().
std::string note_polygons(const LrbRep& rep);

/// Reorients inward-oriented components and returns their number. Adds a note if there were any.
std::uint32_t turn_outward(CheckedMesh& mesh, std::vector<std::string>& notes);

/// Returns the reasons why the mesh cannot become an LRB-rep, even if it were reoriented.
std::string obstacles_to_build(const CheckedMesh& mesh);

/// Merges coincident vertices where the surface is open (mesh_repair.hpp). Returns a note, or an empty string
/// if there were none.
std::string join_corners_of_mesh(Mesh& mesh);

/// Returns true if the first bytes of a file identify it as an LRB-rep. The name is not considered.
bool is_lrb_file(const std::string& path);

}  // namespace lrb
