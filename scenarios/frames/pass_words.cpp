#include "scenarios/frames/pass_words.hpp"

#include <cmath>

#include <lrbscope/render/overlay.hpp>

namespace lrb::run {

std::string pass_words(const trace::PassSummary& pass) {
  std::string out = "pass " + std::to_string(pass.number()) + ": " +
                    render::counted(pass.regions, "region", "regions") + ", " +
                    render::group_digits(pass.faces_before) + " to " +
                    render::counted(pass.faces_after, "face", "faces");
  if (pass.refused() > 0)
    out += ", " + render::counted(pass.refused(), "cap", "caps") +
           " refused: " + trace::refusal_words(pass.caps);
  return out;
}

std::string stage_words(const trace::PassSummary& pass) {
  std::string out(name_of(pass.stage));
  if (pass.most_off > 0) out += ", caps at most " + render::short_number(pass.most_off) + " off the body";
  return out;
}

namespace {

std::string cap_words(const trace::Event& e) {
  const std::string size =
      e.b == 0 ? "no cap, nothing could be left out"
               : "cap of " + render::counted(e.a, "face", "faces") + " over " + render::group_digits(e.b);
  std::string out = size + ": " + std::string(name_of(e.verdict()));
  if (std::isfinite(e.off())) out += ", " + render::short_number(e.off()) + " off the body";
  return out;
}

}  // namespace

std::string built_words(const trace::Event& e) {
  switch (e.kind) {
    case EventKind::pass:
      return "pass " + std::to_string(e.a + 1) + " begins: " + std::string(name_of(e.stage()));
    case EventKind::patch:
      return "patch of " + render::counted(e.b, "face", "faces") + " grown from vertex " +
             std::to_string(e.a);
    case EventKind::cap:
      return cap_words(e);
    case EventKind::region:
      return "region " + std::to_string(e.a) + " made: " + render::counted(e.b, "face", "faces") +
             " under it";
    case EventKind::merged:
      return render::counted(e.b, "inner shell", "inner shells") + " became part of region " +
             std::to_string(e.a);
    case EventKind::closed:
      return "built: " + render::counted(e.a, "region", "regions") + ", outermost wrapper of " +
             render::counted(e.b, "face", "faces");
    default:
      return {};
  }
}

}  // namespace lrb::run
