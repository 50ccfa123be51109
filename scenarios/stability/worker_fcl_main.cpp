// FCL compiled with our flags alone: see scenarios/methods/peers.cmake.
#include "scenarios/stability/worker.hpp"

int main(int argc, char** argv) {
  return lrb::stability::worker_main(argc, argv, {lrb::methods::fcl_headers()});
}
