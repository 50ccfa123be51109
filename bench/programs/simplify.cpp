/// lrbscope-simplify N...: reads a mesh of triangles (OFF) from file descriptor 3, simplifies it to N faces
/// for each N, largest first, and prints a line for each: its number of faces, and the one-sided Hausdorff
/// distances from the result to the mesh and back, both sampled. Edges are collapsed by Garland and
/// Heckbert's quadrics, which may cut off corners: the result does not enclose the mesh. A separate program,
/// because CGAL's licence is the GPL.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh/IO/OFF.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace simplification = CGAL::Surface_mesh_simplification;

double largest_distance(const Mesh& from, const Mesh& to) {
  constexpr unsigned kPoints = 50000;
  return CGAL::Polygon_mesh_processing::approximate_Hausdorff_distance<CGAL::Sequential_tag>(
      from, to, CGAL::parameters::number_of_points_on_faces(kPoints).random_seed(1));
}

void simplify(Mesh& mesh, std::size_t faces) {
  // Stops when fewer edges are left.
  const simplification::Count_stop_predicate<Mesh> stop(faces * 3 / 2 + 1);
  const simplification::GarlandHeckbert_policies<Mesh, Kernel> quadrics(mesh);
  simplification::edge_collapse(
      mesh, stop, CGAL::parameters::get_cost(quadrics.get_cost()).get_placement(quadrics.get_placement()));
}

int run(int count, char** arguments) {
  constexpr int kBadInput = 2;
  std::ifstream in("/proc/self/fd/3");
  Mesh mesh;
  if (!CGAL::IO::read_OFF(in, mesh)) return kBadInput;
  Mesh work = mesh;
  for (int i = 1; i < count; ++i) {
    simplify(work, std::strtoul(arguments[i], nullptr, 10));
    Mesh result = work;
    result.collect_garbage();
    std::printf("%zu %.17g %.17g\n", static_cast<std::size_t>(num_faces(result)),
                largest_distance(result, mesh), largest_distance(mesh, result));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    return run(count, arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
