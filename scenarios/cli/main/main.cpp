#include "scenarios/cli/command.hpp"

int main(int argc, char** argv) {
  return lrb::cli::main(argc, argv);
}
