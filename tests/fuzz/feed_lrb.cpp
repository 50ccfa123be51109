#include "tests/fuzz/feed.hpp"
#include "tests/support/lrb_files.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::fuzz {
namespace {

/// A file that is accepted may be nonsense as a body, but using it must be safe. Only small bodies are
/// queried, in floating point, as using costs more than reading does; feed_fields.cpp calls all readers.
void use(const LrbRep& rep) {
  static constexpr std::size_t kSmall = 64;  // corners
  if (rep.data().face_vertices.size() > kSmall) return;
  CollideRequest request;
  request.predicates = Predicates::floating;
  static_cast<void>(collide(rep, Pose{}, rep, Pose::translation({0.5, 0.25, 0}), request));
}

}  // namespace

bool feed_lrb(std::string_view bytes) {
  if (bytes.empty()) return false;
  std::string file(bytes.substr(1));
  if (bytes[0] & 1) file = test::with_right_checksum(file);
  return accepted("m.lrb", [&] { use(load_lrb(file, "m.lrb")); });
}

}  // namespace lrb::fuzz
