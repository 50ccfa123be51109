// The main() of every worker program: what differs is which methods it is linked with
// (scenarios/methods/methods.cmake).
#include "scenarios/worker_programs/worker.hpp"

int main(int argc, char** argv) {
  return lrb::worker_programs::worker_main(argc, argv, lrb::methods::registered_methods());
}
