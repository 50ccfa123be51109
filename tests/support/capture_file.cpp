#include "tests/support/capture_file.hpp"

#include <array>
#include <vector>

#define LRBCAP_ENABLE
#define LRBCAP_IMPLEMENTATION
#include <lrbscope_capture.h>

namespace lrb::test {
namespace {

std::array<double, 12> numbers_of(const Pose& pose) {
  std::array<double, 12> out{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      out[static_cast<std::size_t>(4 * row + column)] = column < 3 ? pose.r(row, column) : pose.t[row];
  return out;
}

std::uint32_t write_tree(const capture::Tree& t, std::uint32_t mesh, std::uint32_t replaces) {
  std::vector<double> directions;
  for (const Eigen::Vector3d& d : t.directions) directions.insert(directions.end(), d.data(), d.data() + 3);
  lrbcap_tree out = {};
  out.mesh = mesh;
  out.replaces = replaces;
  out.nodes = static_cast<std::uint32_t>(t.size());
  out.volume = static_cast<std::uint32_t>(t.volume);
  out.directions = static_cast<std::uint32_t>(t.directions.size());
  out.first_child = t.first_child.data();
  out.child = t.child.data();
  out.first_prim = t.first_triangle.data();
  out.prim = t.triangle.data();
  out.volumes = t.volumes.data();
  out.direction = directions.data();
  return LRBCAP_TREE(&out);
}

void write_event(const capture::Event& e, const std::vector<std::uint32_t>& names) {
  switch (e.kind) {
    case capture::EventKind::nodes:
      LRBCAP_NODES(e.a, e.b, e.tests, e.met, e.axis);
      break;
    case capture::EventKind::triangles:
      LRBCAP_PRIM(e.a, e.b, e.met);
      break;
    case capture::EventKind::count:
      LRBCAP_COUNT(names[e.a], e.b);
      break;
    case capture::EventKind::phase:
      LRBCAP_PHASE(names[e.a]);
      break;
  }
}

}  // namespace

void write_capture(const capture::Capture& capture, const std::string& path) {
  LRBCAP_OPEN(capture.engine.c_str(), path.c_str());
  std::vector<std::uint32_t> names, meshes, trees;
  for (const std::string& name : capture.names) names.push_back(LRBCAP_NAME(name.c_str()));
  for (const capture::Mesh& m : capture.meshes) {
    std::vector<double> xyz;
    for (const Eigen::Vector3d& v : m.vertices) xyz.insert(xyz.end(), v.data(), v.data() + 3);
    meshes.push_back(LRBCAP_MESH(m.name.c_str(), m.vertices.size(), xyz.data(), m.triangles.size(),
                                 m.triangles.empty() ? nullptr : m.triangles.front().data()));
  }
  for (const capture::Tree& t : capture.trees)
    trees.push_back(write_tree(t, meshes[t.mesh], t.replaces == kNull ? 0 : trees[t.replaces]));
  for (const capture::Query& q : capture.queries) {
    const auto tree = [&](std::size_t side) { return q.trees[side] == kNull ? 0 : trees[q.trees[side]]; };
    LRBCAP_BEGIN(static_cast<std::uint32_t>(q.kind) + 1, tree(0), numbers_of(q.poses[0]).data(), tree(1),
                 numbers_of(q.poses[1]).data());
    for (const capture::Event& e : q.events) write_event(e, names);
    LRBCAP_END(q.verdict, q.pairs);
  }
  LRBCAP_CLOSE();
}

}  // namespace lrb::test
