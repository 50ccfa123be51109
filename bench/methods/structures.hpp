#pragma once
/// The structures that the paper compares the LRB-rep with, as methods: sphere tree, BSP tree, B-rep with an
/// index of space, hierarchical grid.

#include <cstddef>
#include <vector>

#include "bench/methods/method.hpp"

namespace lrb::methods {

/// The body of one of them.
class SizedBody : public MethodBody {
 public:
  /// Returns the size of the structure, without the faces.
  virtual std::size_t bytes() const = 0;
};

std::vector<MethodEntry> structures_methods();

}  // namespace lrb::methods
