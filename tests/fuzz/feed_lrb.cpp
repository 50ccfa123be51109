#include <cstring>

#include "tests/fuzz/feed.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::fuzz {

void put_checksum_right(std::string& file) {
  constexpr std::size_t kVersionAt = 8, kChecksum = sizeof(std::uint64_t);
  std::uint32_t version = 0;
  if (file.size() < kVersionAt + sizeof version + kChecksum) return;
  std::memcpy(&version, file.data() + kVersionAt, sizeof version);
  const std::uint64_t value =
      lrb_checksum(std::string_view(file).substr(0, file.size() - kChecksum), version);
  file.replace(file.size() - kChecksum, kChecksum, reinterpret_cast<const char*>(&value), kChecksum);
}

namespace {

/// A file that is accepted may be nonsense as a body, but using it must be safe. One use for each input, of a
/// small body: using costs more than reading does. For the same reason all pairs are decided in floating
/// point; exact predicates, slow for hostile numbers, are used until the first pair, and are tested by the
/// torture suite.
void use(const LrbRep& rep, int how) {
  static constexpr std::size_t kSmall = 64;  // corners
  if (rep.data().face_vertices.size() > kSmall) return;
  CollideRequest request;
  switch (how) {
    case 1:
      request.recursion = Recursion::paper;
      [[fallthrough]];
    case 0:
      request.predicates = Predicates::floating;
      static_cast<void>(collide(rep, Pose{}, rep, Pose::translation({0.5, 0.25, 0}), request));
      return;
    case 2: {
      ValidateOptions options;
      options.embedding = false;
      options.wrapper_states = 2;
      static_cast<void>(validate(rep, options));
      return;
    }
    default:
      request.mode = Mode::any_pair;
      static_cast<void>(collide(rep, Pose{}, rep, Pose::translation({0.5, 0.25, 0}), request));
      if (!rep.has_levels()) return;
      request = {};
      request.predicates = Predicates::floating;
      request.tolerance = 1;
      static_cast<void>(collide(rep, Pose{}, rep, Pose::translation({0.5, 0.25, 0}), request));
      return;
  }
}

}  // namespace

bool feed_lrb(std::string_view bytes) {
  if (bytes.empty()) return false;
  std::string file(bytes.substr(1));
  if (bytes[0] & 1) put_checksum_right(file);
  return accepted("m.lrb", [&] { use(load_lrb(file, "m.lrb"), bytes[0] >> 1 & 3); });
}

}  // namespace lrb::fuzz
