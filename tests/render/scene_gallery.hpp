#pragma once

#include <string>

namespace lrb::test {
/// Writes pictures of scenes, of bodies made by hand.
void scene_gallery(const std::string& folder);
}  // namespace lrb::test
