// build_and_validate MESH OUT.lrb: builds, proves and saves an LRB-rep; a query within 1 % of its size.
#include <exception>
#include <iostream>

#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/world_box.hpp>

int main(int argc, char** argv) try {
  if (argc != 3) throw lrb::InputError("usage: build_and_validate MESH OUT.lrb");
  const lrb::LrbRep built = lrb::build_lrb(lrb::read_mesh(argv[1]));  // closed, manifold and oriented
  std::cout << built.real_face_count() << " real faces, " << built.region_count() << " regions, "
            << built.outermost_faces().size() << " faces in the outermost wrapper\n";

  // Exact proof: cells are closed, and faces intersect only in their common edges and vertices.
  const lrb::ValidateReport proof = lrb::validate(built);
  for (const std::string& violation : proof.violations) std::cerr << violation << "\n";
  if (!proof.valid) return 1;
  std::cout << "proven: " << proof.embedding_pairs << " pairs of triangles tested exactly\n";

  built.levels();  // wrappers for coarse queries: made now, and saved with the body
  lrb::save_lrb(built, argv[2]);
  const lrb::LrbRep body = lrb::load_lrb(argv[2]);

  // The body and a copy of it. The relation stays exact; the pairs belong to wrappers near the bodies.
  const Eigen::AlignedBox3d box = lrb::world_box(body, {});
  const lrb::Pose pose_b = lrb::Pose::translation(0.4 * box.sizes());
  lrb::CollideRequest request;
  request.tolerance = 0.01 * box.diagonal().norm();
  const lrb::CollideResult coarse = lrb::collide(body, {}, body, pose_b, request);
  const lrb::CollideResult exact = lrb::collide(body, {}, body, pose_b);
  std::cout << lrb::name_of(coarse.relation) << ": " << coarse.pairs.size()
            << " pairs with an error of at most " << coarse.error_bound << ", " << exact.pairs.size()
            << " exact pairs\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
