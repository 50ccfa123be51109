// watch A B X Y Z: prints each region that a query refines and each pair of triangles that it tests.
#include <cstdlib>
#include <exception>
#include <iostream>

#include <lrbscope/body.hpp>
#include <lrbscope/observe.hpp>

/// Prints the events of a query. Other functions of CollideProbe report tree nodes, planes and phases.
struct Printer : lrb::CollideProbe {
  void refine(lrb::Side side, lrb::RegionId region, std::uint32_t faces_added) override {
    std::cout << "refine region " << region << " of " << lrb::name_of(side) << ": " << faces_added
              << " faces more\n";
  }
  // depth: number of regions between a triangle and the outside
  void face_test(lrb::SimplexId a, lrb::SimplexId b, lrb::exact::Meet meet, std::uint32_t depth_a,
                 std::uint32_t depth_b) override {
    std::cout << "test triangle " << a << " of A (depth " << depth_a << ") and " << b << " of B (depth "
              << depth_b << "): " << lrb::name_of(meet) << "\n";
  }
};

int main(int argc, char** argv) try {
  if (argc != 6) throw lrb::InputError("usage: watch A B X Y Z");
  const lrb::Body a = lrb::Body::load(argv[1]).value();
  const lrb::Body b = lrb::Body::load(argv[2]).value();
  const lrb::Pose pose_b =
      lrb::Pose::translation({std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])});
  lrb::CollideRequest request;
  request.mode = lrb::Mode::any_pair;  // stops at the first pair
  Printer printer;
  const lrb::CollideResult result = lrb::collide(a, {}, b, pose_b, request, printer);
  std::cout << lrb::name_of(result.relation) << " after " << result.counters.face_tests << " tests\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
