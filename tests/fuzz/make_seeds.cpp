/// fuzz_seeds DIR: writes the seeds of every format into DIR/FORMAT/.

#include <cstdio>
#include <filesystem>

#include "tests/fuzz/seeds.hpp"
#include <lrbscope/core/file.hpp>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: fuzz_seeds DIR\n", stderr);
    return 2;
  }
  for (const lrb::fuzz::Format& format : lrb::fuzz::formats()) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / format.name;
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < format.seeds.size(); ++i)
      lrb::write_file((folder / ("seed" + std::to_string(i))).string(), format.seeds[i]);
  }
}
