// Asks whether two boxes, one moved by three quarters of its side, meet. Ends with 0 if the answer is right.
#include <iostream>

#include "engine/query/collide.hpp"

int main() {
  lrb::Mesh box;
  for (int i = 0; i < 8; ++i) box.vertices.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  for (const auto& f :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    box.add_face(
        std::array{lrb::VertexId(f[0]), lrb::VertexId(f[1]), lrb::VertexId(f[2]), lrb::VertexId(f[3])});
  const lrb::LrbRep body = lrb::LrbRep::without_regions(box, true, false);
  const lrb::CollideResult r = lrb::collide(body, {}, body, lrb::Pose::translation({0.75, 0.75, 0.75}), {});
  std::cout << lrb::to_string(r.relation) << ", " << r.pairs.size() << " pairs\n";
  return r.relation == lrb::Relation::crossing ? 0 : 1;
}
