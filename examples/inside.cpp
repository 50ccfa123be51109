// inside MESH N: where a mesh intersects itself; of N^3 points in its box, how many are inside, how deep.
#include <cstdlib>
#include <exception>
#include <iostream>
#include <vector>

#include <lrbscope/body.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/self_intersections.hpp>

int main(int argc, char** argv) try {
  const int n = argc == 3 ? std::atoi(argv[2]) : 0;
  if (n < 1 || n > 200) throw lrb::InputError("usage: inside MESH N, with N from 1 to 200");
  lrb::BodyOptions options;
  options.regions = false;  // none are needed
  const lrb::Body body = lrb::Body::load(argv[1], options).value();
  const lrb::SelfIntersections found = lrb::self_intersections(body.rep());
  std::vector<double> length(found.curves);  // total length of each curve
  for (const lrb::SelfIntersection& pair : found.pairs)
    for (std::uint32_t i = pair.first_segment; i < pair.first_segment + pair.segments; ++i)
      length[pair.curve] += (found.segments[i][1] - found.segments[i][0]).norm();
  std::cout << "pairs of faces that intersect: " << found.pairs.size() << "; curves: " << found.curves;
  for (const double x : length) std::cout << ", of length " << x;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : body.rep().vertices()) box.extend(v);
  const Eigen::Vector3d step = box.sizes() / n, first = box.min() + step / 2;  // centres of cells
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < n * n * n; ++i)
    points.push_back(first + step.cwiseProduct(Eigen::Vector3d(i % n, i / n % n, i / n / n)));
  std::size_t inside = 0;
  double least = box.diagonal().norm();  // negative inside
  for (const lrb::PointDistance& d : lrb::point_distances(body, {}, points)) {
    inside += d.side == lrb::Where::inside;
    if (d.signed_upper() < least) least = d.signed_upper();
  }
  std::cout << "\ninside: " << inside << " of " << points.size() << "; smallest distance " << least << "\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
