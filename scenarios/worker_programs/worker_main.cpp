#include "scenarios/worker_programs/worker.hpp"

int main(int argc, char** argv) {
  using namespace lrb::methods;
  return lrb::worker_programs::worker_main(
      argc, argv,
      {ours(), ours_floating(), ours_paper(), ours_coherent(), ours_tolerance(), ours_budget(),
       plain_double(), fcl_double(), fcl_float(), cgal_rigid(), cgal_pairs(), bullet(), embree(),
       embree_rebuilt(), ode(), spheres(), fcl_octree(), fcl_gjk()});
}
