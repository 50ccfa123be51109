#pragma once
/// A body for queries, made in one call of whatever the user has: matrices, arrays, a mesh, a file. What is
/// wrong with it comes back as a reason that names the element, not as an exception.

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

struct BodyOptions {
  BuildOptions build;   ///< threads, quality (`lean`, `patch_interior`, `max_outer_faces`), seed, progress
  bool regions = true;  ///< false: faces alone, in a tenth of the time or less; then there are no wrappers
  bool turn = true;     ///< turn components that are inside out; Body::notes() says so
  bool join =
      true;  ///< join corners in exactly the same place when a file is read, where the surface is open there
  std::string name = "body";  ///< for messages, of bodies that come from no file
};
/// Returns a BodyOptions as it is by default.
const BodyOptions& default_body_options();

/// A body that can be queried. Const once made, and shared by its copies, which cost nothing: give each
/// thread one. Stands wherever a `const LrbRep&` is asked for; must then outlive what refers to it.
///
/// What bounds no solid (holes, edges of three faces, faces that disagree on which side is outside) is a
/// body, too: pairs, contacts and distances are exact as of any other. It has no wrappers, and nothing lies
/// inside it: where its surface meets nothing, CollideResult::relation is `separate` if the bodies' boxes in
/// the world are apart, else `undefined`. notes() says why.
///
/// A body with regions has cells that are proven closed (validate_cells()). If that proof fails, of a mesh or
/// of an .lrb file, the body has its faces only, and notes() says what failed and where.
class Body {
 public:
  /// Makes a body of a matrix of vertices (n x 3, or n x 2 in the plane; any scalar) and one of faces (m x 3
  /// triangles, m x k polygons of k corners, or m x 2 segments of a body in the plane; any integer). Refuses,
  /// by index, what is not finite and corners that do not exist, and as Mesh does.
  template <class V, class F>
  static Expected<Body> from(const Eigen::MatrixBase<V>& vertices, const Eigen::MatrixBase<F>& faces,
                             const BodyOptions& options = default_body_options());

  /// Does the same for arrays: x, y, z of each vertex; three corners of each triangle.
  static Expected<Body> from(std::span<const double> coordinates, std::span<const std::uint32_t> corners,
                             const BodyOptions& options = default_body_options());
  static Expected<Body> from(std::span<const double> coordinates, std::span<const std::int32_t> corners,
                             const BodyOptions& options = default_body_options());
  static Expected<Body> from(std::span<const double> coordinates, std::span<const std::int64_t> corners,
                             const BodyOptions& options = default_body_options());

  /// Does the same for a mesh; its name is used, unless it has none.
  static Expected<Body> from(Mesh mesh, const BodyOptions& options = default_body_options());

  /// Takes an LRB-rep that has been made elsewhere, and that others may have, too.
  static Body from(LrbRep rep);
  static Body from(std::shared_ptr<const LrbRep> rep);

  /// Reads a mesh file as read_mesh() does, or an .lrb file, told apart by content.
  static Expected<Body> load(const std::string& path, const BodyOptions& options = default_body_options());

  const LrbRep& rep() const { return *held_->rep; }
  operator const LrbRep&() const { return *held_->rep; }

  const std::string& name() const { return rep().name(); }
  int dim() const { return rep().dim(); }
  /// Returns true if its surface bounds a solid, so that relations other than touching and crossing have a
  /// meaning.
  bool is_solid() const { return rep().closed(); }
  /// Returns true if it has wrappers beyond its own surface. Bodies of few faces may need none.
  bool has_regions() const { return rep().region_count() > 0; }
  /// Returns the number of components that were inside out and were turned.
  std::uint32_t turned() const { return held_->turned; }
  /// Returns what was done to it, and what cannot be asked of it and why; one line each, for people.
  std::span<const std::string> notes() const { return held_->notes; }

  /// Returns true if both are the same body, as copies are.
  friend bool operator==(const Body& x, const Body& y) { return x.held_ == y.held_; }

 private:
  struct Held {
    std::shared_ptr<const LrbRep> rep;
    std::vector<std::string> notes;
    std::uint32_t turned = 0;
  };

  explicit Body(std::shared_ptr<const Held> held) : held_(std::move(held)) {}
  /// `coordinates`: row by row, `each` to a vertex; `corners`: row by row, `each_face` to a face.
  static Expected<Body> from_rows(std::span<const double> coordinates, std::size_t each,
                                  std::span<const std::int64_t> corners, std::size_t each_face,
                                  const BodyOptions& options);
  static Body made(Mesh mesh, const BodyOptions& options, std::vector<std::string> notes = {});

  std::shared_ptr<const Held> held_;
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

// Makes an LRB-rep of whatever mesh there is, and says what was done: what lrb::Body and the program have in
// common.

struct MadeBody {
  LrbRep rep;
  std::vector<std::string> notes;  ///< what was done to it or could not be done; one line each, for people
  double build_seconds = 0;        ///< 0 if nothing was built
  std::uint32_t turned = 0;        ///< number of components that were inside out
};

/// Turns what is inside out, if `turn`, and builds; what cannot be an LRB-rep, or has one whose proof fails,
/// becomes a body without regions, and a note says why. Throws InputError if it cannot be queried at all.
MadeBody make_body(CheckedMesh mesh, const BuildOptions& options, bool turn = true);

/// Does the same without regions, for callers that ask only for pairs of faces, distances and the relation:
/// builds no LRB-rep, and proves nothing about the mesh that these answers do not need. Faces have the same
/// numbers.
MadeBody make_body_of_faces(CheckedMesh mesh, bool turn = true);

/// Returns a note with the first violation if the proof of an LRB-rep's cells fails (validate_cells()), or an
/// empty text if they are proven.
std::string note_unproven(const LrbRep& rep);
/// Returns the LRB-rep if its cells are proven; if not, its real faces without regions, and adds that note.
LrbRep proven(LrbRep rep, std::vector<std::string>& notes);

/// Turns what is inside out and returns the number of components. Adds a note if there were any.
std::uint32_t turn_outward(CheckedMesh& mesh, std::vector<std::string>& notes);

/// Says why there can be no LRB-rep of a mesh, even if it were turned.
std::string obstacles_to_build(const CheckedMesh& mesh);

/// Joins corners in exactly the same place where the surface is open there (mesh_repair.hpp). Returns a note
/// that says so; empty if there were none.
std::string join_corners_of_mesh(Mesh& mesh);

/// Returns true if a file says that it is an LRB-rep (by its first bytes, not its name).
bool is_lrb_file(const std::string& path);

}  // namespace lrb
