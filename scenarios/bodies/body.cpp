#include "scenarios/bodies/body.hpp"

#include "engine/core/error.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "engine/mesh/io/mesh_io.hpp"

namespace lrb::bodies {
namespace {

LoadedBody loaded(MadeBody made) {
  return {std::move(made.rep), std::move(made.notes), made.build_seconds};
}

}  // namespace

LrbRep build_from_mesh(CheckedMesh mesh, const BuildOptions& options, std::vector<std::string>& notes) {
  if (!mesh.report().when_turned().buildable())
    throw InputError(mesh.mesh().name + ": cannot be an LRB-rep: " + obstacles_to_build(mesh) +
                     " | it can still be queried, not built");
  turn_outward(mesh, notes);
  return build_lrb(mesh, options);
}

LoadedBody body_of_mesh(Mesh mesh, const BuildOptions& options) {
  return body_of_mesh(check(std::move(mesh)), options);
}

LoadedBody body_of_mesh(CheckedMesh mesh, const BuildOptions& options) {
  return loaded(make_body(std::move(mesh), options));
}

LoadedBody load_body(const std::string& path, const BuildOptions& options) {
  if (is_lrb_file(path)) return {load_lrb(path), {}, 0};
  return body_of_mesh(read_mesh(path), options);
}

LoadedBody load_faces(const std::string& path) {
  if (is_lrb_file(path)) return {load_lrb(path), {}, 0};
  return faces_of_mesh(read_mesh(path));
}

LoadedBody faces_of_mesh(Mesh mesh) {
  return loaded(make_body_of_faces(check(std::move(mesh))));
}

}  // namespace lrb::bodies
