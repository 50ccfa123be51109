// Asks whether two bodies from files, one of them moved, meet. Ends with 0 if they cross.
#include <iostream>

#include <lrbscope/body.hpp>
#include <lrbscope/collide.hpp>

int main(int, char** argv) {
  const lrb::Body a = lrb::Body::load(argv[1]).value(), b = lrb::Body::load(argv[2]).value();
  const lrb::CollideResult r = lrb::collide(a, {}, b, lrb::Pose::translation({0.01, 0, 0}), {});
  std::cout << lrb::to_string(r.relation) << ", " << r.pairs.size() << " pairs\n";
  return r.relation == lrb::Relation::crossing ? 0 : 1;
}
