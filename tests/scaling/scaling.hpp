#pragma once
/// Growth of time and memory: families of generated inputs of any size, and the measured operations.
///
/// A file that adds families says so in a variable of its own; no list elsewhere needs to know:
///
///     const bool added = add({"drum", "check", "corners", kShare, kMore, [](std::uint32_t n) {
///       auto mesh = std::make_shared<Mesh>(drum(n));
///       return Task{double(n), [mesh] { check_mesh(*mesh); }};
///     }});

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lrb::scaling {

using Sizes = std::vector<std::uint32_t>;

/// The sizes that most families are measured at.
inline const Sizes kShare = {1000, 2000, 4000, 8000}, kMore = {16000, 32000, 64000};

/// One input with its measured operation.
struct Task {
  double size = 0;             ///< what time and memory are fitted against: of the input, and of the answer
  std::function<void()> work;  ///< may be called several times
};

struct Family {
  std::string input, work;           ///< name in the table: "drum", "query"
  std::string unit;                  ///< unit of the size: "corners"
  std::vector<std::uint32_t> share;  ///< sizes for the test suite: a second or two together
  std::vector<std::uint32_t> more;   ///< further sizes, larger, for the whole run
  std::function<Task(std::uint32_t size)> make;
  double max_time = 1.35;  ///< allowed powers; n log n is 1.1 to 1.15 at these sizes
  double max_memory = 1.2;
};

/// Adds a family to those that the command measures. Returns true, so that a variable can be set to it.
bool add(Family family);

}  // namespace lrb::scaling
