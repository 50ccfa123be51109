// instances A.obj RAYS POSES: the first hit of each ray with copies of a mesh, one for each pose, by two
// levels: a tree of the copies, and the tree of the mesh in each of them.
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include <algorithm>

#include "bodies.hpp"

/// Traces rays through a tree of instances, and in each of them through the tree of the mesh.
class InstanceTracer final : public RayTracer {
  MeshTracer body;
  const std::vector<Pose>& poses;

 public:
  InstanceTracer(const Triangles& mesh, const Tree& of_mesh, const Tree& of_poses, const std::vector<Pose>& p)
      : RayTracer(of_poses), body(mesh, of_mesh), poses(p) {}
  std::uint32_t describe_tree(const char* name) override {
    const std::vector<std::uint32_t> bodies(poses.size(), body.describe_tree(name));
    Description of(LRBCAP_AABB, tree.nodes, tree.boxes);
    return LRBCAP_INSTANCES("copies", &of.tree, std::uint32_t(poses.size()), bodies.data(), poses[0].data());
  }
  void test(std::uint32_t instance) override {
    // The ray in the frame of the instance: y = R^T (x - t). Multiples of its direction stay as they are.
    const Pose& pose = poses[instance];
    for (std::size_t k = 0; k < 3; ++k) {
      body.ray[k] = body.ray[3 + k] = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        body.ray[k] += pose[4 * i + k] * (ray[i] - pose[4 * i + 3]);
        body.ray[3 + k] += pose[4 * i + k] * ray[3 + i];
      }
    }
    body.ray[6] = ray[6], body.ray[7] = ray[7];
    LRBCAP_ENTER(instance, LRBCAP_TOP);  // a ray has no instances
    body.visit(0);
    LRBCAP_ENTER(LRBCAP_TOP, LRBCAP_TOP);
    ray[7] = body.ray[7];
  }
};

int main(int, char** argv) {
  const Triangles mesh = read_obj(argv[1]);
  const std::vector<Pose> poses = read_poses(argv[3]);
  Tree of_mesh, of_poses;
  of_mesh.add(boxes_of(mesh), 0, mesh.corners.size() / 3);
  std::vector<double> boxes;  // of each copy: least x, y, z, greatest x, y, z
  for (const Pose& pose : poses) {
    double box[6] = {1e300, 1e300, 1e300, -1e300, -1e300, -1e300};
    for (std::size_t v = 0; v < mesh.vertices.size(); v += 3)
      for (std::size_t k = 0; k < 3; ++k) {
        double x = pose[4 * k + 3];
        for (std::size_t i = 0; i < 3; ++i) x += pose[4 * k + i] * mesh.vertices[v + i];
        box[k] = std::min(box[k], x), box[3 + k] = std::max(box[3 + k], x);
      }
    boxes.insert(boxes.end(), box, box + 6);
  }
  of_poses.add(boxes, 0, poses.size());
  return InstanceTracer(mesh, of_mesh, of_poses, poses).run("rays with instances", argv[1], argv[2]);
}
