#pragma once

#include <stdexcept>
#include <string>

namespace lrb {

/// Thrown for input that cannot be used. The message is one line that names the file, the line or element,
/// what was expected and what to do. Commands end with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown when the machine cannot do what is asked (no off-screen context, disk full, a missing font).
/// Commands end with exit code 3.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lrb
