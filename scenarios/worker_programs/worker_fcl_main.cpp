// FCL compiled with our flags alone: see scenarios/methods/peers/peers.cmake.
#include "scenarios/worker_programs/worker.hpp"

int main(int argc, char** argv) {
  return lrb::worker_programs::worker_main(argc, argv, {lrb::methods::fcl_headers()});
}
