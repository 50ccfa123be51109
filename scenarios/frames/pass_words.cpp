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
           " rejected: " + trace::refusal_words(pass.caps);
  return out;
}

std::string stage_words(const trace::PassSummary& pass) {
  std::string out(name_of(pass.stage));
  if (pass.most_off > 0) out += ", max. deviation " + render::short_number(pass.most_off);
  return out;
}

namespace {

std::string cap_words(const trace::Event& e) {
  const trace::payload::Cap cap = e.cap();
  const std::string size = cap.covered == 0 ? "no cap, because no vertex could be removed"
                                            : "cap of " + render::counted(cap.faces, "face", "faces") +
                                                  " over " + render::group_digits(cap.covered);
  std::string out = size + ": " + std::string(name_of(cap.verdict));
  if (std::isfinite(cap.off)) out += ", deviation " + render::short_number(cap.off);
  return out;
}

}  // namespace

std::string built_words(const trace::Event& e) {
  switch (e.kind) {
    case EventKind::pass:
      return "pass " + std::to_string(e.pass().layer + 1) + " begins: " + std::string(name_of(e.stage()));
    case EventKind::patch:
      return "patch of " + render::counted(e.patch().faces, "face", "faces") + " grown from vertex " +
             std::to_string(e.patch().vertex);
    case EventKind::cap:
      return cap_words(e);
    case EventKind::region:
      return "region " + std::to_string(e.region()) +
             " created: " + render::counted(e.wrapper_change().faces, "face", "faces") + " covered";
    case EventKind::merged:
      return render::counted(e.merged().pieces, "inner shell", "inner shells") + " merged into region " +
             std::to_string(e.merged().into);
    case EventKind::closed:
      return "built: " + render::counted(e.closed().regions, "region", "regions") +
             ", outermost wrapper of " + render::counted(e.closed().outer_faces, "face", "faces");
    default:
      return {};
  }
}

}  // namespace lrb::run
