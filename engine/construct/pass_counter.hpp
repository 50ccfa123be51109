#pragma once

#include <cstdint>

#include "engine/construct/build.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/fitting.hpp"

namespace lrb::construct {

/// Counts the passes of a builder, and tells its probe of them. A region's layer is the number of the pass
/// that made it; a pass that makes no region does not count, so that no layer is empty.
class PassCounter {
 public:
  explicit PassCounter(const BuildOptions& options) : options_(options) {}

  std::uint16_t layer() const { return static_cast<std::uint16_t>(pass_); }

  /// Tells that a pass begins.
  void tell_begin(BuildStage stage, std::uint32_t hull_faces, double most_off = 0) const {
    if (options_.probe) options_.probe->pass({stage, pass_, hull_faces, most_off});
  }
  /// Tells that it ends.
  void tell_end(const PassEnd& end) const {
    if (options_.probe) options_.probe->end_pass(end);
  }
  /// Tells of the regions from number `first` on.
  void tell_regions(const ComplexBuilder& complex, std::uint32_t first) const {
    if (!options_.probe) return;
    for (RegionId r(first); r < complex.region_count(); ++r) options_.probe->region(r);
  }

  /// Counts the pass, and reports it with the number of faces that the hull has left.
  void end_pass(const ComplexBuilder& complex, std::uint32_t hull_faces) {
    if (complex.region_count() == regions_) return;
    regions_ = complex.region_count();
    ++pass_;
    if (options_.progress) options_.progress(pass_, hull_faces);
  }

 private:
  const BuildOptions& options_;
  std::uint32_t pass_ = 0;     ///< the number of the next pass
  std::uint32_t regions_ = 0;  ///< regions before it
};

}  // namespace lrb::construct
