#pragma once
/// Real models against each other, near contact.

#include <filesystem>
#include <vector>

#include "bench/cases/families.hpp"

namespace lrb::torture {

class Models {
 public:
  /// The six models that lrbscope's figures are about, as far as the folder has them, each with regions and
  /// scaled by a power of two to a size of about one; and small copies that fit into the others.
  void load(const std::filesystem::path& folder);
  bool empty() const { return bodies_.empty(); }
  std::size_t size() const { return bodies_.size(); }

  /// Two models, or a model and a small generated body, moved together or apart until they all but touch; or
  /// from there a little in or out, or far in; or one inside the other.
  cases::Case make(cases::RandomEngine& random, double difficulty) const;

 private:
  std::vector<cases::Body> bodies_;  ///< ascending in size
};

}  // namespace lrb::torture
