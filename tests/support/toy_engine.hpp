#pragma once
/// FaultyEngine with trees of AABBs split in the median, queries at translations, and lies by function.

#include <functional>
#include <string>

#include "tests/support/faulty_engine.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::test {

/// Returns a mesh of triangles as an engine would describe it.
inline capture::Mesh captured(const Mesh& mesh, std::string name = "body") {
  capture::Mesh out;
  out.name = std::move(name);
  out.vertices = mesh.vertices;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f);
    out.triangles.push_back({corners[0].value(), corners[1].value(), corners[2].value()});
  }
  return out;
}

class ToyEngine : public FaultyEngine {
 public:
  ToyEngine() { capture.engine = "Toy 1.0"; }

  /// Changes the result of a test of two triangles; empty: none.
  std::function<bool(std::uint32_t a, std::uint32_t b, bool meets)> wrong;

  /// Adds a mesh with its tree, and returns the tree's index.
  std::uint32_t add(const capture::Mesh& mesh, std::size_t leaf_size = 2) {
    capture::Tree tree = halving_tree(mesh, capture::VolumeKind::aabb, leaf_size);
    tree.mesh = FaultyEngine::add(mesh);
    tree.id = tree.mesh + 1;
    capture.trees.push_back(std::move(tree));
    return capture.trees.back().mesh;
  }

  /// Performs a query with B at a translation, and returns the number of pairs found.
  std::uint64_t query(std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& translation,
                      capture::QueryKind kind = capture::QueryKind::all_pairs) {
    capture::Query& q = ask(a, {}, b, Pose::translation(translation), {.kind = kind});
    q.begin_ns = 1000.0 * q.number;
    q.duration_ns = 500;
    q.pairs = 0;
    for (capture::Event& e : q.events) {
      if (e.kind != capture::EventKind::triangles) continue;
      if (wrong) e.met = wrong(e.a, e.b, e.met != 0);
      q.pairs += e.met;
    }
    q.verdict = q.pairs > 0 ? capture::Verdict::intersecting : capture::Verdict::separate;
    return q.pairs;
  }
};

}  // namespace lrb::test
