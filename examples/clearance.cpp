// clearance A B X Y Z: B moves from (X, Y, Z) to (0, 0, 0). Distance before, first contact, overlap after.
#include <cstdlib>
#include <exception>
#include <iostream>

#include <lrbscope/body.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/first_contact.hpp>

int main(int argc, char** argv) try {
  if (argc != 6) throw lrb::InputError("usage: clearance A B X Y Z");
  const lrb::Body a = lrb::Body::load(argv[1]).value();
  const lrb::Body b = lrb::Body::load(argv[2]).value();
  const lrb::Pose pose_a, end;
  const lrb::Pose start =
      lrb::Pose::translation({std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])});
  const Eigen::IOFormat xyz(6, Eigen::DontAlignCols, ", ", "", "", "", "(", ")");

  // Each quantity is an interval that is proven to contain the exact value.
  const lrb::DistanceResult distance = lrb::distance(a, pose_a, b, start);
  std::cout << "start: distance " << distance.upper << ", error <= " << distance.upper - distance.lower
            << ", from " << distance.witness[0].point.transpose().format(xyz) << " to "
            << distance.witness[1].point.transpose().format(xyz) << "\n";

  const lrb::Motion motion_a, motion_b = lrb::Motion::linear(start, end.t);  // t from 0 to 1
  const lrb::FirstContactResult first = lrb::first_contact(a, motion_a, b, motion_b);
  std::cout << "motion: " << lrb::name_of(first.outcome);
  if (first.is_contact()) std::cout << " at t = " << first.t1 << ", error <= " << first.t1 - first.t0;

  const lrb::ClashResult clash = lrb::clash(a, pose_a, b, end);
  std::cout << "\nend: " << lrb::name_of(clash.kind);
  if (clash.reason != lrb::ClashReason::none) std::cout << ": " << lrb::name_of(clash.reason);
  if (clash.depth)  // none for meshes that are not closed
    std::cout << ", depth " << clash.depth->upper << ", error <= " << clash.depth->upper - clash.depth->lower
              << ", B is free when moved by " << clash.translation.transpose().format(xyz);
  std::cout << "\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
