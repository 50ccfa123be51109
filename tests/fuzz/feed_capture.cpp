#include <span>
#include <vector>

#include "tests/fuzz/feed.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::fuzz {
namespace {

void in_range(bool kept, const char* what) {
  if (!kept) throw std::logic_error(what);
}

/// Reads everything that a capture promises to be in range.
void use(const capture::Capture& c) {
  for (const capture::Mesh& mesh : c.meshes)
    for (const auto& corners : mesh.triangles)
      for (const std::uint32_t v : corners) in_range(v < mesh.vertices.size(), "a vertex out of range");
  for (const capture::Tree& tree : c.trees) {
    in_range(tree.mesh < c.meshes.size(), "a mesh out of range");
    in_range(tree.replaces == kNull || tree.replaces < c.trees.size(), "a replaced tree out of range");
    in_range(tree.first_child.size() == tree.size() + 1 && tree.first_triangle.size() == tree.size() + 1 &&
                 tree.volumes.size() == tree.size() * tree.numbers() && tree.size() != 0,
             "arrays of a tree of other sizes");
    for (std::uint32_t n = 0; n < tree.size(); ++n) {
      for (const std::uint32_t child : tree.children(n))
        in_range(child < tree.size(), "a child out of range");
      in_range(tree.first_triangle[n + 1] <= tree.triangle.size(), "triangles out of range");
    }
  }
  for (const capture::Query& q : c.queries) {
    std::size_t stored = 0;
    for (const capture::Part& part : q.parts) {
      in_range(part.first == stored, "parts that do not follow each other");
      stored += part.count;
    }
    in_range(stored == q.events.size(), "events of no part");
    for (const capture::Event& e : q.events)
      for (const bool b : {false, true}) {
        if (e.kind == capture::EventKind::count || e.kind == capture::EventKind::phase) {
          in_range(e.a < c.names.size(), "a name out of range");
          continue;
        }
        if (q.trees[b] == kNull) continue;
        const capture::Tree& tree = c.trees[q.trees[b]];
        const std::size_t end =
            e.kind == capture::EventKind::nodes ? tree.size() : c.meshes[tree.mesh].triangles.size();
        in_range((b ? e.b : e.a) < end, "an event out of range");
      }
  }
}

}  // namespace

bool feed_capture(std::string_view bytes) {
  std::uint32_t last = kNull;
  if (!bytes.empty() && bytes[0] >= 0 && bytes[0] < 8) {
    last = static_cast<std::uint32_t>(bytes[0]);
    bytes.remove_prefix(1);
  }
  const std::vector<char> exact(bytes.begin(), bytes.end());  // so that a sanitizer notices the end
  return accepted("run.lrbcap", [&] {
    use(capture::parse_capture(std::as_bytes(std::span(exact)), "run.lrbcap", 1, last));
  });
}

}  // namespace lrb::fuzz
