#pragma once

#include <stdexcept>
#include <string>

namespace lrb {

/// Input that cannot be used: the message is one line that names the file, the line or element, what was
/// expected and what to do. Commands end with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine cannot do what is asked (no off-screen context, disk full, a missing font). Exit code 3.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lrb
